// Trees and vehicles.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"
#include "tiles/world/site.hpp"

namespace roadfix::world {

/// Trees in gardens, parks and orchards and along streets, on free ground.
void plant(Plan& plan, const Site& site, Random& random);

/// Cars and buses: parked along kerbs and moving in lanes.
std::vector<Box> traffic(const Plan& plan, Random& random);

}  // namespace roadfix::world
