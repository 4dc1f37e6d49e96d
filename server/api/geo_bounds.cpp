#include "server/api/geo_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix::api {

GeoBounds bounds_of(const UtmZone& zone, const GridBox& box) {
  // Along a side the extreme lies between samples by less than its curvature over one step: centimetres for a city.
  constexpr int kSteps = 16;
  const double somewhere_deg = zone.unproject(box.min).lon_deg;
  GeoBounds bounds{{90.0, 540.0}, {-90.0, -540.0}};
  for (int i = 0; i <= kSteps; ++i) {
    const double east = box.min.east_m + box.width_m() * i / kSteps;
    const double north = box.min.north_m + box.height_m() * i / kSteps;
    for (const GridPoint p : {GridPoint{east, box.min.north_m}, GridPoint{east, box.max.north_m},
                              GridPoint{box.min.east_m, north}, GridPoint{box.max.east_m, north}}) {
      LatLon at = zone.unproject(p);
      at.lon_deg = somewhere_deg + std::remainder(at.lon_deg - somewhere_deg, 360.0);
      bounds.south_west = {std::min(bounds.south_west.lat_deg, at.lat_deg),
                           std::min(bounds.south_west.lon_deg, at.lon_deg)};
      bounds.north_east = {std::max(bounds.north_east.lat_deg, at.lat_deg),
                           std::max(bounds.north_east.lon_deg, at.lon_deg)};
    }
  }
  return bounds;
}

}  // namespace roadfix::api
