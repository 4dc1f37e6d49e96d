// A pose on the Earth, and the same on the plane of a zone.
#pragma once

#include "core/geodesy/utm.hpp"

namespace roadfix {

/// Position and *true* heading (clockwise from true north), as the API speaks of them.
struct GeoPose {
  LatLon position;
  Angle heading;
};

/// The same on the plane of the zone, its heading from grid north. Throws as UtmZone::project().
GridPose on_grid(const GeoPose& pose, const UtmZone& zone);
/// And back, its heading within (-180, 180] degrees.
GeoPose on_earth(const GridPose& pose, const UtmZone& zone);

}  // namespace roadfix
