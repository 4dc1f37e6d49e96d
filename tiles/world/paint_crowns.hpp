// Crowns of the open country: broadleaves, conifers, shrubs, and bare branches in winter.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_crown(Canvas& canvas, const Tree& tree, const Conditions& conditions);

}  // namespace roadfix::world
