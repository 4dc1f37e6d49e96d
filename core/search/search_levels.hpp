// The pyramid that a search goes down: levels from the finest cells to those of the scan, and which poses on a level
// are distinct places.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/search/level.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

inline constexpr std::size_t kSurvivors = 96;  ///< followed from each finer level
/// Between candidates that are followed, in cells and heading bins of the scan.
inline constexpr double kCandidatesApartCells = 2.5;
inline constexpr int kCandidatesApartBins = 2;
inline constexpr int kDistinctBins = 3;  ///< heading bins of the scan, between distinct places

/// How far beyond the headings of a region a better place is looked for, as it is on the ground around the region: the
/// flanks of such a peak reach into the region.
inline const Angle kHeadingsBeyond = Angle::degrees(5.0);

/// Two poses are distinct if they are farther apart than this in place or in heading.
struct PoseSpacing {
  double metres;
  int coarse_bins;  ///< of the scan's level
};

class SearchLevels {
 public:
  /// All outlive the levels.
  SearchLevels(const GridReader& read, double finest_cell_m, const FeatureMap& features, const PoseRegion& region,
               const SearchOptions& options);

  /// Index of the level that is scanned; the finest one has 0.
  int coarsest() const { return static_cast<int>(levels_.size()) - 1; }
  const Level& at(int index) const { return levels_[static_cast<std::size_t>(index)]; }
  const Level& coarse() const { return levels_.back(); }
  const Level& finest() const { return levels_.front(); }
  /// Cells of this level are 2^halvings times as large as the finest ones given; more than `index` for large
  /// footprints, which leave the finest levels out.
  int halvings(int index) const { return finest_ + index; }
  const PoseRegion& region() const { return region_; }
  /// The longer side of the feature map.
  double side_m() const { return side_m_; }
  /// How many candidates are followed from a level to the next finer one.
  std::size_t candidates_followed(int index) const;
  /// The level whose lattice of poses a proof covers.
  int proof_level() const;
  /// The coarsest level whose cells are no larger than those that calibrations are learned in: scores in larger ones
  /// spread farther.
  int spread_level() const;

  /// The region and a step of the level's lattice around it, so that each of its poses has a neighbour on the lattice.
  static PoseRegion widened(const PoseRegion& region, const Level& level);
  /// Whether the pose lies in the widened region.
  bool within_region(const Level& level, const LatticePose& pose) const;
  /// The poses that are distinct from every better one, best first: up to `keep` from within the region, as many from
  /// around it, and as many at headings beyond its range, which in a grid of streets fit as well and would crowd out
  /// those around.
  std::vector<LatticePose> distinct(std::vector<LatticePose> poses, const Level& level, const PoseSpacing& spacing,
                                    std::size_t keep) const;
  /// The same with the spacing of candidates that are followed.
  std::vector<LatticePose> distinct_candidates(std::vector<LatticePose> poses, const Level& level,
                                               std::size_t keep) const;

 private:
  const PoseRegion& region_;
  double side_m_;
  double seen_m_;              ///< side of a square as large as the ground that was seen
  int finest_ = 0;             ///< halvings() of the finest level
  std::vector<Level> levels_;  ///< finest first
};

/// The bins whose headings lie in the region.
std::vector<int> bins_within(const HeadingBins& bins, const PoseRegion& region);

/// Whether the middle of the cell (column, row) of `positions` lies in the region.
std::function<bool(int, int)> cells_within(const GridGeometry& positions, const PoseRegion& region);

/// From the cells of one level to those of the next finer one.
void descend(std::vector<LatticePose>& candidates);

}  // namespace roadfix
