// The earthquake in the open country: fallen trees and landslides on roads, collapsed farm buildings.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// The same ground after the event. That share of the buildings falls, and the harder it shook the more tracks are
/// blocked.
Plan after_earthquake_in_country(const Plan& before, double collapsed_share, Random& random);

}  // namespace roadfix::world
