// A railway line: two thin rails on sleepers in a bed of ballast.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_railway(Canvas& canvas, const Countryside& country, const Conditions& conditions);

}  // namespace roadfix::world
