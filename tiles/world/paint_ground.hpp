// Open ground, fields, water, lots, trees and rubble.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_ground(Canvas& canvas, const Plan& plan, const Conditions& conditions);
void paint_trees(Canvas& canvas, const Plan& plan, const Conditions& conditions);
void paint_debris(Canvas& canvas, const Plan& plan);

}  // namespace roadfix::world
