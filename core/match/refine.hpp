// Follows a candidate of the coarse scan down to the cells of the map: exact scores of the poses around it.
#pragma once

#include <array>
#include <vector>

#include "core/match/correlation.hpp"
#include "core/match/heading_bins.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/match/search.hpp"
#include "core/match/work.hpp"

namespace roadfix {

/// One level of the pyramid.
struct Level {
  const GridReader& read;
  FeatureMap features;  ///< in the cells of this level
  HeadingBins bins{2};
  double least_cells = 0.0;
  int threads = 1;

  double cell_m() const { return features.cell_m; }
  GridPose pose_of(const LatticePose& pose) const;
};

/// Replaces each candidate by the best pose within +- `cells` and +- `bins` of it. False if time was over before: then
/// they are left as they were.
bool refine(const Level& level, int cells, int bins, const Deadline& deadline, std::vector<LatticePose>& candidates);

/// Scores around a pose: index [bin][row][col], each from -kPeakRadius to +kPeakRadius; the bins count as headings.
inline constexpr int kPeakRadius = 3;
inline constexpr int kPeakSize = 2 * kPeakRadius + 1;
using PeakScores = std::array<std::array<std::array<double, kPeakSize>, kPeakSize>, kPeakSize>;
struct Peak {
  PeakScores scores{};
  MatchSums centre;  ///< at the pose itself
};
Peak peak_around(const Level& level, const LatticePose& pose);

}  // namespace roadfix
