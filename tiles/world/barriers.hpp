// What roads of the country keep out of: a stream or river, ponds, a railway.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// Sets river, ponds and railway where the seed has them, where they meet few roads. Paved roads cross both by bridges
/// and level crossings; tracks end before them.
void lay_barriers(Plan& plan, Random& random);

}  // namespace roadfix::world
