// Uniform and normal numbers from random bits, the same with every standard library: its distributions differ.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace roadfix {

/// In [0, 1), of 64 random bits.
constexpr double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1.0p-53; }

/// In [low, high); `random()` gives 64 random bits, as std::mt19937_64 does.
template <typename Generator>
double uniform(Generator& random, double low, double high) {
  return low + (high - low) * unit_interval(random());
}

/// Two independent standard normal numbers of two in [0, 1), by Box and Muller.
inline std::pair<double, double> normal_pair(double u, double v) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - u));
  const double direction = 2.0 * std::numbers::pi * v;
  return {radius * std::cos(direction), radius * std::sin(direction)};
}

template <typename Generator>
std::pair<double, double> normal_pair(Generator& random) {
  const double u = unit_interval(random());
  return normal_pair(u, unit_interval(random()));
}

/// Standard normal.
template <typename Generator>
double normal(Generator& random) {
  return normal_pair(random).first;
}

}  // namespace roadfix
