// Open country small enough to be laid out in a test.
#pragma once

#include "tiles/world/country.hpp"

namespace roadfix::world::testing {

inline Plan empty_country(double side_m) {
  Plan plan;
  plan.width_m = side_m;
  plan.height_m = side_m;
  return plan;
}

inline Plan small_country(std::uint64_t seed, double side_m = 400.0) {
  Plan plan = empty_country(side_m);
  lay_out_country(plan, seed);
  return plan;
}

}  // namespace roadfix::world::testing
