#include "core/units/planar.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

double largest_variance_m2(const PoseCovariance& c) {
  return 0.5 * (c[0][0] + c[1][1]) + std::hypot(0.5 * (c[0][0] - c[1][1]), c[0][1]);
}

GridBox united(const GridBox& a, const GridBox& b) {
  return {{std::min(a.min.east_m, b.min.east_m), std::min(a.min.north_m, b.min.north_m)},
          {std::max(a.max.east_m, b.max.east_m), std::max(a.max.north_m, b.max.north_m)}};
}

GridBox united(std::span<const GridBox> boxes) {
  GridBox all = kEmptyBox;
  for (const GridBox& box : boxes) all = united(all, box);
  return all;
}

GridBox box_around(std::span<const GridPoint> points) {
  GridBox box = kEmptyBox;
  for (const GridPoint point : points) box = united(box, {point, point});
  return box;
}

GridBox intersection(const GridBox& a, const GridBox& b) {
  return {{std::max(a.min.east_m, b.min.east_m), std::max(a.min.north_m, b.min.north_m)},
          {std::min(a.max.east_m, b.max.east_m), std::min(a.max.north_m, b.max.north_m)}};
}

GridBox grown(const GridBox& box, double by_m) {
  return {{box.min.east_m - by_m, box.min.north_m - by_m}, {box.max.east_m + by_m, box.max.north_m + by_m}};
}

GridPoint nearest(const GridBox& box, GridPoint point) {
  return {std::clamp(point.east_m, box.min.east_m, box.max.east_m),
          std::clamp(point.north_m, box.min.north_m, box.max.north_m)};
}

double distance_m(GridPoint a, GridPoint b) { return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m); }

double distance_m(const BodyOffset& offset) { return std::hypot(offset.forward_m, offset.right_m); }

bool contains(const GridCircle& circle, GridPoint point) { return distance_m(point, circle.centre) <= circle.radius_m; }

GridPose moved(const GridPose& reference, const BodyOffset& by) {
  const auto& [position, heading] = reference;
  const double c = cos(heading);
  const double s = sin(heading);
  return {{position.east_m + c * by.right_m + s * by.forward_m, position.north_m - s * by.right_m + c * by.forward_m},
          (heading + by.turn).wrapped()};
}

BodyOffset offset_from(const GridPose& reference, const GridPose& pose) {
  const double east = pose.position.east_m - reference.position.east_m;
  const double north = pose.position.north_m - reference.position.north_m;
  const double c = cos(reference.heading);
  const double s = sin(reference.heading);
  return {s * east + c * north, c * east - s * north, (pose.heading - reference.heading).wrapped()};
}

}  // namespace roadfix
