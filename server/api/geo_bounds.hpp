// A map's extent in degrees.
#pragma once

#include "core/geodesy/utm.hpp"

namespace roadfix::api {

struct GeoBounds {
  LatLon south_west;
  LatLon north_east;
};

/// Smallest box of latitude and longitude around the grid's box, whose sides are curves there. `box` is not empty.
/// West is less than east: across the antimeridian one of them lies beyond 180 degrees.
GeoBounds bounds_of(const UtmZone& zone, const GridBox& box);

}  // namespace roadfix::api
