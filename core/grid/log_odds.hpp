// Cells as log-odds, in which what several sources or frames say of one place is averaged.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/grid/cell.hpp"

namespace roadfix {

/// Log odds of an observed cell. Certainty is bounded at a quarter of a step of the cell scale (p = 1/1016), the mean
/// of what rounds to 0.
inline double log_odds(Cell cell) {
  constexpr double kMin = 0.25 / kRoad;
  const double p = std::clamp(probability(cell), kMin, 1.0 - kMin);
  return std::log(p / (1.0 - p));
}

inline Cell cell_from_log_odds(double log_odds) { return cell_from_probability(1.0 / (1.0 + std::exp(-log_odds))); }

}  // namespace roadfix
