// What the blocks are used for, and the buildings that stand in them.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"
#include "tiles/world/site.hpp"

namespace roadfix::world {

/// Sets blocks and buildings of the plan: rows of buildings along the rim of each block that is built on, up to three
/// deep, entered into the site.
void develop(Plan& plan, Site& site, Random& random);

}  // namespace roadfix::world
