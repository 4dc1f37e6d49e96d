// The open country as a plan: fields, woods, water, roads and farmsteads, in the order in which they need each other.
#pragma once

#include <cstdint>

#include "tiles/world/plan.hpp"

namespace roadfix::world {

/// Fills the plan, whose size must be set.
void lay_out_country(Plan& plan, std::uint64_t seed);

}  // namespace roadfix::world
