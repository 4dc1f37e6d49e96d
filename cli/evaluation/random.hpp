// One random stream for each query: results do not depend on the order or number of threads.
#pragma once

#include <cstdint>
#include <random>

#include "core/units/draws.hpp"

namespace roadfix::evaluation {

using Random = std::mt19937_64;

inline Random stream(std::uint64_t seed, std::uint64_t set, std::uint64_t query) {
  std::seed_seq sequence{seed, seed >> 32, set, query};
  return Random(sequence);
}

}  // namespace roadfix::evaluation
