// Where does a feature map fit best? Every position of a region and every heading of a range, coarse to fine.
//
// Coarse: in cells of 8 m, 16 m for a footprint of 480 m or in a large region or 32 m for a footprint of kilometres,
// with enough of them across the footprint, all poses are scored by FFT correlation. Fine: the best distinct candidates
// are followed down the pyramid to the cells of the map (of a footprint of more than 512 of them across, to coarser
// ones), then within the cell. It is not exact: a true pose that is not among the candidates at the coarse level is
// missed.
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

/// Modes that are compared at full resolution, however few are asked for: what the figures of a search say of its best
/// place was learned with so many.
inline constexpr int kRankedModes = 8;

struct SearchOptions {
  int max_modes = kRankedModes;  ///< more of them follow those that are compared; fewer change nothing else
  /// The ground in the feature map may be smaller by this share, or larger by as much (altitude known roughly), in
  /// [0, kMaxScaleRange].
  double scale_range = 0.0;
  int threads = 1;
  /// Of the map: within it the ground around the region is searched as well, half a footprint beyond and 4 km^2 in all
  /// at least, and headings a little beside, to tell what chance gives and whether another place fits better. nullopt =
  /// no farther than it takes to tell anything of chance.
  std::optional<GridBox> surroundings{};
  /// So many of the longest straight lines do not count in SearchResult::other_roads_m: two, since junctions look
  /// alike; one where a place is known and has to be borne out.
  int straight_roads = 2;
  std::shared_ptr<SearchCache> cache{};  ///< of this map; nullptr = what is built is not kept
  Deadline deadline{};                   ///< at it the search ends with what it has; Interrupted when asked to stop
  /// How far the scan is, which is the longest part: so many headings at a scale of all.
  OnProgress progress{};
  /// How long to look for a better pose than the best candidate, within the deadline; nullopt = no proof.
  std::optional<std::chrono::milliseconds> proof_time{};
};

/// What is known of all poses of the region, not just of the candidates.
struct SearchProof {
  double cell_m = 0.0;  ///< of the lattice of positions that it speaks of
  int headings = 0;     ///< bins within the range
  int scales = 1;
  double best_score = 0.0;      ///< of the best pose found, on this lattice
  double bound = 1.0;           ///< no pose on this lattice scores more; equal to best_score if `complete`
  bool complete = false;        ///< the best pose is proven to be the best; else time was over before
  double excluded_share = 0.0;  ///< of the poses that cannot be better than the best, at least; 1 if `complete`
};

/// A place that fits, apart from the others by a tenth of the footprint or several heading bins.
struct SearchMode {
  GridPose pose;
  double scale = 1.0;  ///< of the feature map's size, within the scale range
  double score = 0.0;
  double pearson = 0.0;  ///< equation (5) about the separate means, at the nearest cell
  std::int64_t observed_cells = 0;
  PoseCovariance covariance{};  ///< from the shape of the peak, and the cell size
};

/// What scores look like by chance over the searched region.
struct ScoreBackground {
  double sd = 0.0;  ///< of all scanned poses, about 0, in cells of at most 8 m
  std::int64_t poses = 0;
  /// Scores of the best distinct places beside the best mode, also of such around the region; descending.
  std::vector<double> rivals;
  /// Those of them that lie within the region.
  std::vector<double> rivals_within;
  /// Share of the places that `rivals` came from which lies within the region, in (0, 1].
  double region_share = 1.0;

  /// Log-likelihood ratio of a pose against chance: -(n / 2) log(1 - r^2), as if map and feature map were jointly
  /// normal and 1 / sd^2 the number of independent samples. kTemper says how far that is trusted, since the errors of
  /// neighbouring cells are not independent.
  double log_likelihood(double score) const;
  /// Assumed. The calibration makes up for it in the ellipses of modes (core/locate/calibration.hpp), not in their
  /// weights beside the best one.
  static constexpr double kTemper = 0.25;
};

struct SearchResult {
  std::vector<SearchMode> modes;  ///< best first; empty where no pose has enough observed cells
  /// Length of the roads in both that the score of the best mode rests on beside the longest straight lines among them
  /// (SearchOptions::straight_roads, shared_road.hpp).
  std::optional<double> other_roads_m;
  /// Another peak within the region, so close to the best mode that the two are no distinct places, at its heading and
  /// scale: no higher than the mode. What the map knows of its own accuracy tells whether it is another place.
  std::optional<SearchMode> nearby;
  /// The best places around the region, or beside its headings (by 5 degrees, or far likelier), with surroundings
  /// given; best first.
  std::vector<SearchMode> outside;
  ScoreBackground background;
  double cell_m = 0.0;               ///< finest cell
  double coarse_cell_m = 0.0;        ///< of the exhaustive scan
  int headings = 0;                  ///< bins of the exhaustive scan within the range
  int scales = 1;                    ///< of the exhaustive scan
  std::optional<SearchProof> proof;  ///< where one was asked for
  /// Share of the poses that were scored at the coarse cells before the deadline; of the others nothing is known.
  double scanned_share = 1.0;
  /// What the scan found was followed to the finest cells; else the modes are only near the peaks.
  bool refined = true;

  bool complete() const { return refined && scanned_share == 1.0; }
};

/// `features` in cells of `finest_cell_m` (see resampled()), with an observed cell that is not like all others.
/// At the deadline it stops and says what it has; throws Interrupted when asked to stop.
SearchResult search(const GridReader& read, double finest_cell_m, const FeatureMap& features, const PoseRegion& region,
                    const SearchOptions& options);

}  // namespace roadfix
