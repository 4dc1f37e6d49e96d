// What an earthquake leaves in the open country: landslides, fallen trees.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_slides(Canvas& canvas, const Countryside& country);
void paint_logs(Canvas& canvas, const Countryside& country, const Conditions& conditions);

}  // namespace roadfix::world
