// Buildings as a camera sees them that does not look quite straight down: facade, then the roof with what stands on it.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_buildings(Canvas& canvas, const Plan& plan, const Conditions& conditions);

}  // namespace roadfix::world
