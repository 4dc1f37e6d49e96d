#include "core/units/planar.hpp"

#include <cmath>

namespace roadfix {

double distance_m(GridPoint a, GridPoint b) { return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m); }

GridPoint beside(const GridPose& pose, double right_m, double forward_m) {
  const double c = cos(pose.heading);
  const double s = sin(pose.heading);
  return {pose.position.east_m + c * right_m + s * forward_m, pose.position.north_m - s * right_m + c * forward_m};
}

}  // namespace roadfix
