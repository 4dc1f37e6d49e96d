// The shape of a score peak: its top within the cell, and how sharp it is.
#pragma once

#include <array>

#include "core/match/refine.hpp"

namespace roadfix {

struct PeakShape {
  /// Where the top is, from the middle of the scores: columns, rows, bins; each within +-0.5.
  std::array<double, 3> offset{};
  /// Covariance of (column, row, bin), from the likelihood over the poses around.
  std::array<std::array<double, 3>, 3> covariance{};
};

/// Offsets from the middle (columns, rows, bins, each up to kPeakRadius) of the largest score.
std::array<int, 3> highest(const PeakScores& scores);

/// The middle must hold the largest score.
PeakShape shape_of(const PeakScores& scores, const ScoreBackground& background);

}  // namespace roadfix
