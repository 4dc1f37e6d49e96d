// Woods' ground, meadows and fields with their rows, and the narrow bands between them that are no roads.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_parcels(Canvas& canvas, const Plan& plan, const Conditions& conditions);

}  // namespace roadfix::world
