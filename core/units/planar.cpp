#include "core/units/planar.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

GridBox united(const GridBox& a, const GridBox& b) {
  return {{std::min(a.min.east_m, b.min.east_m), std::min(a.min.north_m, b.min.north_m)},
          {std::max(a.max.east_m, b.max.east_m), std::max(a.max.north_m, b.max.north_m)}};
}

GridBox grown(const GridBox& box, double by_m) {
  return {{box.min.east_m - by_m, box.min.north_m - by_m}, {box.max.east_m + by_m, box.max.north_m + by_m}};
}

GridPoint nearest(const GridBox& box, GridPoint point) {
  return {std::clamp(point.east_m, box.min.east_m, box.max.east_m),
          std::clamp(point.north_m, box.min.north_m, box.max.north_m)};
}

double distance_m(GridPoint a, GridPoint b) { return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m); }

GridPoint beside(const GridPose& pose, double right_m, double forward_m) {
  const double c = cos(pose.heading);
  const double s = sin(pose.heading);
  return {pose.position.east_m + c * right_m + s * forward_m, pose.position.north_m - s * right_m + c * forward_m};
}

}  // namespace roadfix
