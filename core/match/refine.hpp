// Follows a candidate of the coarse scan down to the cells of the map: exact scores of the poses around it.
#pragma once

#include <array>
#include <vector>

#include "core/grid/feature_rotator.hpp"
#include "core/match/correlation.hpp"
#include "core/match/deadline.hpp"
#include "core/match/heading_bins.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/match/scales.hpp"
#include "core/match/search.hpp"

namespace roadfix {

/// The feature map in the cells of a level, at one scale.
struct LevelFeatures {
  FeatureMap map;
  FeatureRotator rotator;
  std::int64_t full_cells = 0;  ///< observed
  double min_cells = 1.0;       ///< observed in both, below which a pose has no score

  LevelFeatures(FeatureMap features, double min_share);
};

/// One level of the pyramid.
struct Level {
  const GridReader& read;
  const FeatureMap& source;  ///< what the search was given
  LevelFeatures features;    ///< in the cells of this level, as large as it was given
  double min_share = 0.5;
  HeadingBins bins{2};
  Scales scales;
  int threads = 1;

  double cell_m() const { return features.map.cell_m; }
  LevelFeatures at_scale(int index) const;
  /// Cells that the footprint reaches at a scale.
  int reach(int scale) const;
  GridPose pose_of(const LatticePose& pose) const;
};

/// So many cells more on every side.
GridGeometry padded(const GridGeometry& geometry, int cells);

/// Replaces each candidate by the best pose within +- `cells`, +- `bins` and +- 1 of the scales around it. False if
/// time was over before: then they are left as they were.
bool refine(const Level& level, int cells, int bins, const Deadline& deadline, std::vector<LatticePose>& candidates);

/// Scores around a pose, at its scale: index [bin][row][col], each from -kPeakRadius to +kPeakRadius; the bins count as
/// headings.
inline constexpr int kPeakRadius = 3;
inline constexpr int kPeakSize = 2 * kPeakRadius + 1;
using PeakScores = std::array<std::array<std::array<double, kPeakSize>, kPeakSize>, kPeakSize>;
struct Peak {
  PeakScores scores{};
  MatchSums centre;  ///< at the pose itself
};
Peak peak_around(const Level& level, const LatticePose& pose);

}  // namespace roadfix
