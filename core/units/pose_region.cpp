#include "core/units/pose_region.hpp"

#include <algorithm>
#include <numbers>

namespace roadfix {

bool PoseRegion::contains(GridPoint point) const {
  return box.contains(point) && (!circle || roadfix::contains(*circle, point));
}

bool PoseRegion::contains(Angle grid_heading) const {
  return heading_half_width.radians() >= std::numbers::pi ||
         angular_distance(grid_heading, heading) <= heading_half_width;
}

double PoseRegion::area_km2() const {
  const double boxed = box.empty() ? 0.0 : box.width_m() * box.height_m() * 1e-6;
  if (!circle) return boxed;
  return std::min(boxed, std::numbers::pi * circle->radius_m * circle->radius_m * 1e-6);
}

PoseRegion PoseRegion::grown(double by_m, Angle by_heading) const {
  PoseRegion result = *this;
  result.box = roadfix::grown(box, by_m);
  if (result.circle) result.circle->radius_m += by_m;
  result.heading_half_width += by_heading;
  return result;
}

}  // namespace roadfix
