// Country roads and unpaved tracks, with verges, wheel marks and grass between them.
#pragma once

#include "tiles/world/canvas.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"

namespace roadfix::world {

void paint_tracks(Canvas& canvas, const Plan& plan, const Conditions& conditions);

}  // namespace roadfix::world
