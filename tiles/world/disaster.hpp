// An earthquake: which buildings fall, where rubble lies, where tents go up, how the light and the air have changed.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"
#include "tiles/world/site.hpp"

namespace roadfix::world {

/// That share of the buildings becomes debris.
void collapse(Plan& plan, double share, Random& random);

/// The same ground after the event: fallen buildings are debris, some trees are gone, vehicles have moved, tents stand
/// on open ground. Whole neighbourhoods fall together; tall buildings fall more often.
Plan after_earthquake(const Plan& before, const Site& site, double collapsed_share, Random& random);

}  // namespace roadfix::world
