// Farmsteads with yards and drives; vehicles and bales of the open country.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// Adds yards (blocks), buildings around them and a drive from each to the street beside it.
void settle(Plan& plan, Random& random);

/// Few vehicles on streets and in yards; bales on stubble and meadows.
std::vector<Box> country_traffic(const Plan& plan, Random& random);

}  // namespace roadfix::world
