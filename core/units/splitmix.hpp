// SplitMix64 (Steele, Lea and Flood: Fast splittable pseudorandom number generators, 2014): numbers that look random,
// from a counter.
#pragma once

#include <cstdint>

#include "core/units/draws.hpp"

namespace roadfix {

/// What its counter goes up by: 2^64 divided by the golden ratio, odd.
inline constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ULL;

/// Its finalizer: a bijection that spreads every bit.
constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

class SplitMix64 {
 public:
  constexpr explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  constexpr std::uint64_t next() { return mix64(state_ += kGoldenGamma); }
  /// In [0, 1).
  constexpr double uniform() { return unit_interval(next()); }

 private:
  std::uint64_t state_;
};

}  // namespace roadfix
