// Random numbers that come out equal with every standard library: worlds of the same seed are the same bytes.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

#include "core/units/splitmix.hpp"

namespace roadfix::world {

class Random {
 public:
  /// `stream` keeps the parts of a world apart: one more tree must not move the streets.
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(seed * kGoldenGamma + stream) {}

  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  bool chance(double probability) { return unit() < probability; }
  /// In [0, count); count > 0.
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(unit() * static_cast<double>(count)); }
  int integer(int low, int high) { return low + static_cast<int>(unit() * (high - low + 1)); }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));
    return radius * std::cos(2.0 * std::numbers::pi * unit());
  }
  std::uint64_t bits() { return engine_(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace roadfix::world
