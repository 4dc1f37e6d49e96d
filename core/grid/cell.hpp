// One map cell in a byte: the probability of road, or unobserved. Unobserved is a value of its own,
// never 0 and never 0.5, and takes part in no sum.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace roadfix {

/// 0..254 = probability k / 254; 255 = unobserved.
using Cell = std::uint8_t;

inline constexpr Cell kNoRoad = 0;
inline constexpr Cell kRoad = 254;
inline constexpr Cell kUnobserved = 255;

constexpr bool is_observed(Cell cell) { return cell != kUnobserved; }

/// More likely road than not.
constexpr bool is_road(Cell cell) { return is_observed(cell) && cell > kRoad / 2; }

/// In [0, 1]. The cell must be observed.
constexpr double probability(Cell cell) {
  assert(is_observed(cell));
  return cell / 254.0;
}

/// Nearest representable probability; values beyond [0, 1] are clamped, NaN is not allowed.
constexpr Cell cell_from_probability(double p) {
  assert(p == p);
  return static_cast<Cell>(std::clamp(p, 0.0, 1.0) * 254.0 + 0.5);
}

}  // namespace roadfix
