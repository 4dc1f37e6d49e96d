#include "core/geodesy/shown_ground.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace roadfix {
namespace {

constexpr double kFarthestM = 10'000.0;  // a zone has an end

bool meets_swapped(const GeoBox& a, const GeoBox& b) {
  return a.south_west.lon_deg <= b.north_east.lat_deg && b.south_west.lat_deg <= a.north_east.lon_deg &&
         a.south_west.lat_deg <= b.north_east.lon_deg && b.south_west.lon_deg <= a.north_east.lat_deg;
}

}  // namespace

std::string shown_ground(const UtmZone& zone, const GridBox& ground) {
  const GeoBox box = geo_box_around(zone, ground);
  return fmt::format("which shows latitude {:.4f} to {:.4f} and longitude {:.4f} to {:.4f}", box.south_west.lat_deg,
                     box.north_east.lat_deg, box.south_west.lon_deg, box.north_east.lon_deg);
}

std::string shown_ground_beside(const GeoBox& asked, double within_m, const UtmZone& zone, const GridBox& ground) {
  const bool swapped = meets_swapped(asked, geo_box_around(zone, grown(ground, std::min(within_m, kFarthestM))));
  return shown_ground(zone, ground) + (swapped ? "; latitude and longitude may be swapped" : "");
}

}  // namespace roadfix
