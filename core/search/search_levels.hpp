// The pyramid that a search goes down: levels from the finest cells to those of the scan, and which of the poses on one
// are places of their own.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/search/level.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

inline constexpr std::size_t kSurvivors = 96;  ///< followed from each finer level
/// Of the scan's cells and headings, between candidates that are followed.
inline constexpr double kCandidatesApartCells = 2.5;
inline constexpr int kCandidatesApartBins = 2;
inline constexpr int kDistinctBins = 3;  ///< of the scan's headings, between places of their own

/// So far beside the headings of a region a place that fits better is looked for, as around it: the flanks of such a
/// peak reach into the region.
inline const Angle kHeadingsBeyond = Angle::degrees(5.0);

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
  /// From the finest cells that were given to those of a level. Large footprints leave the finest levels out.
  int halvings(int index) const { return finest_ + index; }
  const PoseRegion& region() const { return region_; }
  /// The longer side of the feature map.
  double side_m() const { return side_m_; }
  /// How many candidates are followed from a level to the next finer one.
  std::size_t followed(int index) const;
  /// The level that a proof speaks of.
  int proof_level() const;
  /// The coarsest one whose scores spread as those do that calibrations are learned from.
  int spread_level() const;

  /// With a step of the level's lattice around, so that each pose of the region has one of the lattice beside it.
  static PoseRegion widened(const PoseRegion& region, const Level& level);
  /// The widened region.
  bool within_region(const Level& level, const LatticePose& pose) const;
  /// Those that are apart from every better one, best first: up to `keep` from within the region, and as many others.
  std::vector<LatticePose> distinct(std::vector<LatticePose> poses, const Level& level, double apart_m,
                                    int coarse_bins_apart, std::size_t keep) const;
  /// Those that are followed: distinct() ones.
  std::vector<LatticePose> apart(std::vector<LatticePose> poses, const Level& level, std::size_t keep) const;

 private:
  const PoseRegion& region_;
  double side_m_;
  double seen_m_;              ///< side of a square as large as the ground that was seen
  int finest_ = 0;             ///< halvings() of the finest level
  std::vector<Level> levels_;  ///< finest first
};

/// The bins whose headings lie in the region.
std::vector<int> bins_within(const HeadingBins& bins, const PoseRegion& region);

/// Tells of a cell (column, row) of `positions` whether its middle lies in the region.
std::function<bool(int, int)> cells_within(const GridGeometry& positions, const PoseRegion& region);

/// From the cells of one level to those of the next finer one.
void descend(std::vector<LatticePose>& candidates);

}  // namespace roadfix
