// Carriageways, kerbs, markings and what stands on them.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_streets(Canvas& canvas, const Plan& plan, const Conditions& conditions);
/// Vehicles, tents, containers.
void paint_boxes(Canvas& canvas, const Plan& plan);

}  // namespace roadfix::world
