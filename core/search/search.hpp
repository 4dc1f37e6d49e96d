// Where does a feature map fit best? Every position of a region and every heading of a range, coarse to fine.
//
// Coarse: all poses are scored by FFT correlation, in cells of 8 m, in 16 m for footprints from 480 m or in a large
// region, in 32 m for footprints of kilometres, and in finer ones for small footprints (search_levels.cpp). Fine: the
// best distinct candidates are followed down the pyramid to the cells of the map (coarser ones for footprints of more
// than 512 cells across), then within the cell. The search is not exact: a true pose that is not among the candidates
// of the coarse level is missed.
//
// The score of a pose is r * sqrt(n / n_full): Pearson's correlation over the n cells observed in both, of n_full
// observed in the feature map. For chance matches its spread does not depend on n, so small overlaps do not win by
// luck.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/grid/road_grid.hpp"
#include "core/match/deadline.hpp"
#include "core/search/search_cache.hpp"
#include "core/units/pose_region.hpp"
#include "core/units/progress.hpp"

namespace roadfix {

/// Cells of the map at `geometry.cell_m` = finest cell * 2^k; unobserved where the map has none. Thread-safe.
using GridReader = std::function<RoadGrid(const GridGeometry& geometry)>;

inline constexpr double kMaxScaleRange = 0.3;

/// How many modes are compared at full resolution, however few are asked for: calibrations were learned so.
inline constexpr int kRankedModes = 8;

struct SearchOptions {
  int max_modes = kRankedModes;  ///< more of them follow those that are compared; fewer change nothing else
  /// The ground in the feature map may be smaller by this share, or larger by as much (altitude known roughly), in
  /// [0, kMaxScaleRange].
  double scale_range = 0.0;
  int threads = 1;
  /// The extent of the map. Within it the ground around the region is searched, too: at least half a footprint beyond
  /// the region and 4 km^2 in all, and headings a little outside the range, to see what chance gives and whether
  /// another place fits better. nullopt = only as far as it takes to estimate what chance gives.
  std::optional<GridBox> surroundings{};
  /// How many of the longest straight lines do not count in SearchResult::other_roads_m: two, since junctions look
  /// alike; one where the place is known and only has to be confirmed.
  int straight_roads = 2;
  std::shared_ptr<SearchCache> cache{};  ///< of this map; nullptr = what is built is not kept
  Deadline deadline{};                   ///< then the search ends with what it has; Interrupted when asked to stop
  /// Of the scan, which is the longest part: headings done and in all, each counted once per scale.
  OnProgress progress{};
  /// How long to try to prove that no pose is better than the best candidate, within the deadline; nullopt = no proof.
  std::optional<std::chrono::milliseconds> proof_time{};
};

/// What is known of all poses of the region, not just of the candidates.
struct SearchProof {
  double cell_m = 0.0;  ///< of the lattice of positions that it covers
  int headings = 0;     ///< bins within the range
  int scales = 1;
  double best_score = 0.0;      ///< of the best pose found, on this lattice; 0 if none was scored there in time
  double bound = 1.0;           ///< no pose on this lattice scores more; equal to best_score if `complete`
  bool complete = false;        ///< the best pose is proven to be the best; else time ran out
  double excluded_share = 0.0;  ///< of the poses that cannot be better than the best, at least; 1 if `complete`
};

/// A place that fits, a tenth of the footprint or several heading bins away from the others.
struct SearchMode {
  GridPose pose;
  double scale = 1.0;  ///< of the feature map's size, within the scale range
  double score = 0.0;
  double pearson = 0.0;  ///< Pearson's correlation, at the nearest cell
  std::int64_t observed_cells = 0;
  PoseCovariance covariance{};  ///< from the shape of the peak, and the cell size
};

/// What scores chance gives over the searched region.
struct ScoreBackground {
  double sd = 0.0;  ///< root mean square of the scores of all scanned poses, in cells of at most 8 m
  std::int64_t poses = 0;
  /// Scores of the best distinct places other than the best mode, in the region and around it; descending.
  std::vector<double> rivals;
  /// Scores of those that lie within the region, however many `rivals` keeps; descending.
  std::vector<double> rivals_within;
  /// How much of what was searched for `rivals` the region is, in (0, 1].
  double region_share = 1.0;

  /// Log-likelihood ratio of a pose against chance: -(n / 2) log(1 - r^2), as if map and feature map were jointly
  /// normal and 1 / sd^2 the number of independent samples. kTemper says how far that is trusted, since the errors of
  /// neighbouring cells are not independent.
  double log_likelihood(double score) const;
  /// Assumed. The calibration corrects for it in the ellipses of modes (core/locate/calibration.hpp), not in the
  /// weights of other modes relative to the best one.
  static constexpr double kTemper = 0.25;
};

struct SearchResult {
  std::vector<SearchMode> modes;  ///< best first; empty where no pose has enough observed cells
  /// Length of the roads that map and feature map share at the best mode, without the longest straight lines among them
  /// (SearchOptions::straight_roads, shared_road.hpp).
  std::optional<double> other_roads_m;
  /// Another peak within the region, no higher than the best mode, at its heading and scale and too close to be a
  /// distinct place. Whether it counts as another place depends on how accurate the map is.
  std::optional<SearchMode> nearby;
  /// If surroundings are given: the best places around the region, or at headings outside its range (by 5 degrees, or
  /// more if far likelier); best first.
  std::vector<SearchMode> outside;
  ScoreBackground background;
  double cell_m = 0.0;               ///< finest cell
  double coarse_cell_m = 0.0;        ///< of the exhaustive scan
  int headings = 0;                  ///< bins of the exhaustive scan within the range
  int scales = 1;                    ///< of the exhaustive scan
  std::optional<SearchProof> proof;  ///< where one was asked for
  /// Share of the poses that the scan scored before the deadline; of the others nothing is known.
  double scanned_share = 1.0;
  /// The candidates were followed to the finest cells; else the modes are only near the peaks.
  bool refined = true;

  bool complete() const { return refined && scanned_share == 1.0; }
};

/// `features`: in cells of `finest_cell_m` (see resampled()); its observed cells are not all alike.
/// At the deadline it stops and returns what it has; throws Interrupted when asked to stop.
SearchResult search(const GridReader& read, double finest_cell_m, const FeatureMap& features, const PoseRegion& region,
                    const SearchOptions& options);

}  // namespace roadfix
