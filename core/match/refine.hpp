// Follows a candidate of the coarse scan down to the cells of the map: exact scores of the poses around it.
#pragma once

#include <array>
#include <vector>

#include "core/match/correlation.hpp"
#include "core/match/deadline.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/match/level.hpp"

namespace roadfix {

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
