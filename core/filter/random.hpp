// Random numbers addressed by what they are for: the same seed, step and particle give the same numbers, whichever
// thread asks and in whatever order.
#pragma once

#include <cstdint>

#include "core/units/splitmix.hpp"

namespace roadfix {

/// What a stream is drawn for; streams of different purposes are independent.
enum class Draw : std::uint64_t { kStart = 1, kMotion, kResample, kInject, kChoice, kRoughen, kDrift };

class RandomStream {
 public:
  struct Address {
    std::uint64_t seed = 0;
    std::uint64_t step = 0;
    std::uint64_t index = 0;  ///< of the particle
  };
  RandomStream(Draw purpose, const Address& address);

  std::uint64_t next() { return bits_.next(); }
  /// In [0, 1).
  double uniform() { return bits_.uniform(); }
  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal.
  double normal();

 private:
  SplitMix64 bits_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace roadfix
