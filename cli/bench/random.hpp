// One random stream for each query: results do not depend on the order or number of threads.
#pragma once

#include <cstdint>
#include <random>

namespace roadfix::bench {

using Random = std::mt19937_64;

inline Random stream(std::uint64_t seed, std::uint64_t set, std::uint64_t query) {
  std::seed_seq sequence{seed, seed >> 32, set, query};
  return Random(sequence);
}

/// In [low, high).
inline double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

}  // namespace roadfix::bench
