// The scores around a pose: where in between their peak is, and how sharp.
#pragma once

#include <array>
#include <cstddef>

#include "core/match/correlation.hpp"
#include "core/search/level.hpp"

namespace roadfix {

inline constexpr int kPeakRadius = 3;
inline constexpr int kPeakSize = 2 * kPeakRadius + 1;

/// Columns, rows and bins from the pose, each from -kPeakRadius to +kPeakRadius.
class PeakScores {
 public:
  double& at(int col, int row, int bin) { return scores_[index(bin)][index(row)][index(col)]; }
  double at(int col, int row, int bin) const { return scores_[index(bin)][index(row)][index(col)]; }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i + kPeakRadius); }

  std::array<std::array<std::array<double, kPeakSize>, kPeakSize>, kPeakSize> scores_{};
};

struct Peak {
  PeakScores scores;
  MatchSums centre;  ///< at the pose itself
};

/// At the scale of the pose, which counts its heading in `bins`.
Peak peak_around(const Level& level, const HeadingBins& bins, const LatticePose& pose);

struct PeakShape {
  /// Where the top is, from the middle of the scores: columns, rows, bins; each within +-0.5.
  std::array<double, 3> offset{};
  /// Covariance of (column, row, bin), from the likelihood over the poses around.
  std::array<std::array<double, 3>, 3> covariance{};
};

/// Offsets from the middle (columns, rows, bins, each up to kPeakRadius) of the largest score.
std::array<int, 3> highest(const PeakScores& scores);

/// Meant for a middle that holds the largest score. On the flank of a ridge that is followed no further (ModeFinder)
/// the offset ends at its bounds, and the higher neighbours count for the spread, too.
PeakShape shape_of(const PeakScores& scores, const ScoreBackground& background);

}  // namespace roadfix
