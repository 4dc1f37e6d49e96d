#pragma once

#include "core/grid/cell.hpp"

namespace roadfix {

/// The value of unobserved cells in exported rasters of probabilities.
inline constexpr float kNoData = -1.0F;

/// The probability of road in [0, 1], or kNoData.
inline float probability_pixel(Cell cell) {
  return is_observed(cell) ? static_cast<float>(probability(cell)) : kNoData;
}

}  // namespace roadfix
