// Trees of the open country: dense stands, hedges, orchards, scrub, trees along roads and banks.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// Sets the plan's trees, low ones first. None stands on a street, in water, on rails or in a yard, but crowns reach
/// over streets: here they keep off, there they close above a track.
void grow(Plan& plan, Random& random);

}  // namespace roadfix::world
