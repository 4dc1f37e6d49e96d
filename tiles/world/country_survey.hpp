// The open country before roads wander through it: parcels with their covers, and what runs along their boundaries.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// Sets parcels, hedges and strips of the plan, whose size must be set, and the paved roads and field tracks that run
/// between parcels. A square around the picture is split again and again, then everything is bent.
void survey_country(Plan& plan, Random& random);

}  // namespace roadfix::world
