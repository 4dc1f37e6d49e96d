// Random numbers that come out equal with every standard library and compiler: worlds of the same seed are the same. So
// no call has two draws among its arguments, whose order is the compiler's; in braces they come as they stand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "core/units/draws.hpp"
#include "core/units/splitmix.hpp"

namespace roadfix::world {

class Random {
 public:
  /// `stream` keeps the parts of a world apart: one more tree must not move the streets.
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(seed * kGoldenGamma + stream) {}

  /// In [0, 1).
  double unit() { return unit_interval(engine_()); }
  double uniform(double low, double high) { return roadfix::uniform(engine_, low, high); }
  bool chance(double probability) { return unit() < probability; }
  /// In [0, count); count > 0.
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(unit() * static_cast<double>(count)); }
  int integer(int low, int high) { return low + static_cast<int>(unit() * (high - low + 1)); }
  double normal() { return roadfix::normal(engine_); }
  std::uint64_t bits() { return engine_(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace roadfix::world
