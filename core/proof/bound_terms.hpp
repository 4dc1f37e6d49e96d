// An upper bound on scores as a sum: the most that each piece of a feature map can match in its block of the map
// (bound_map.hpp).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace roadfix {

/// The sum over all terms of plane value times weight. Terms of the same weight are a group, side by side in `terms`.
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

/// Rounds weights (>= 0) so that there are few groups: sums are at least (kUp) or at most (kDown) those of the exact
/// weights.
BoundTerms quantized(WeightedTerms weighted, Rounding rounding);

}  // namespace roadfix
