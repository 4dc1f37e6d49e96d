// An invented street network: a ring and radials, arterials, and streets that split the ground between them into
// irregular blocks; no two places look alike.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// Sets streets and river of the plan, whose size must be set. Convex polygons are split on an undistorted plane, then
/// a smooth distortion bends every street. Streets run on beyond the picture.
void invent_streets(Plan& plan, Random& random);

/// Order in which streets are painted and numbered: wider ones last.
void sort_by_width(std::vector<Street>& streets);

}  // namespace roadfix::world
