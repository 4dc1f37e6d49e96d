#include "core/geodesy/geo_pose.hpp"

namespace roadfix {

GridPose on_grid(const GeoPose& pose, const UtmZone& zone) {
  const GridPoint at = zone.project(pose.position);
  return {at, zone.grid_from_true(pose.heading, at)};
}

GeoPose on_earth(const GridPose& pose, const UtmZone& zone) {
  return {zone.unproject(pose.position), zone.true_from_grid(pose.heading, pose.position).wrapped()};
}

}  // namespace roadfix
