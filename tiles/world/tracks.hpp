// Unpaved tracks: what they are made of, and those that leave a road and wander off into woods and meadows.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// A track of any surface and a width of 2.5 to 4 m, still without a line.
Street unpaved(Random& random);

/// Adds tracks that start on streets of the plan. Each winds on until it meets another street, water or rails, or ends
/// blind; those that would cling to another street are left out.
void wander(Plan& plan, Random& random);

}  // namespace roadfix::world
