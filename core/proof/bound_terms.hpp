// The sum that an upper bound on scores is: what the pieces of a feature map find at best, each in its block of the map
// (bound_map.hpp).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace roadfix {

/// A sum over blocks of planes: of the weight of each group of terms times their plane values. Terms of a group lie
/// side by side.
struct BoundTerms {
  struct Term {
    std::int16_t col = 0;  ///< block relative to the nadir's
    std::int16_t row = 0;
    std::int16_t plane = 0;
  };
  struct Group {
    std::uint32_t weight = 0;
    std::uint32_t end = 0;  ///< of its terms, after those of the groups before
  };
  std::vector<Term> terms;
  std::vector<Group> groups;
  double unit = 1.0;  ///< of the weights: sums stay below 2^32
};

enum class Rounding { kUp, kDown };

using WeightedTerms = std::vector<std::pair<double, BoundTerms::Term>>;

/// Weights (>= 0) rounded to a few, so that many terms share one: sums are at least (kUp) or at most (kDown) those of
/// the exact weights.
BoundTerms quantized(WeightedTerms weighted, Rounding rounding);

}  // namespace roadfix
