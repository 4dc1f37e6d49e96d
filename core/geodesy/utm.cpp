#include "core/geodesy/utm.hpp"

#include <fmt/format.h>

#include <GeographicLib/UTMUPS.hpp>
#include <cmath>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

using GeographicLib::UTMUPS;

void require_on_earth(LatLon p) {
  if (!(std::abs(p.lat_deg) <= 90.0) || !(std::abs(p.lon_deg) <= 540.0)) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("latitude {} longitude {} is not a position: latitude must "
                                   "lie within -90..90 and longitude within -180..180 degrees",
                                   p.lat_deg, p.lon_deg));
  }
}

struct Reversed {
  LatLon position;
  Angle convergence;
};

Reversed reverse(const UtmZone& zone, GridPoint point) {
  Reversed result;
  double gamma_deg = 0.0;
  double scale = 0.0;
  try {
    UTMUPS::Reverse(zone.number(), zone.northern(), point.east_m, point.north_m, result.position.lat_deg,
                    result.position.lon_deg, gamma_deg, scale);
  } catch (const GeographicLib::GeographicErr&) {
    throw InvalidInput("position-outside-zone",
                       fmt::format("east {} m north {} m lies outside UTM zone {}{}", point.east_m, point.north_m,
                                   zone.number(), zone.northern() ? 'N' : 'S'));
  }
  result.convergence = Angle::degrees(gamma_deg);
  return result;
}

}  // namespace

UtmZone UtmZone::containing(LatLon point) {
  require_on_earth(point);
  const int number = UTMUPS::StandardZone(point.lat_deg, point.lon_deg);
  if (number < UTMUPS::MINUTMZONE) {
    throw InvalidInput(
        "position-in-polar-region",
        fmt::format("latitude {} lies outside UTM (80 S to 84 N): maps of the polar regions are not supported",
                    point.lat_deg));
  }
  return {number, point.lat_deg >= 0.0};
}

std::optional<UtmZone> UtmZone::from_epsg(int code) {
  const int number = code % 100;
  const int hemisphere = code - number;
  if ((hemisphere != 32600 && hemisphere != 32700) || number < 1 || number > 60) return std::nullopt;
  return UtmZone(number, hemisphere == 32600);
}

std::optional<GridPoint> UtmZone::project_if_defined(LatLon point) const {
  require_on_earth(point);
  try {
    int zone = 0;
    bool north = false;
    double x = 0.0;
    double y = 0.0;
    UTMUPS::Forward(point.lat_deg, point.lon_deg, zone, north, x, y, number_);
    if (north != northern_) y += north ? UTMUPS::UTMShift() : -UTMUPS::UTMShift();
    return GridPoint{x, y};
  } catch (const GeographicLib::GeographicErr&) {
    return std::nullopt;
  }
}

GridPoint UtmZone::project(LatLon point) const {
  if (const auto projected = project_if_defined(point)) return *projected;
  throw InvalidInput(
      "position-outside-zone",
      fmt::format(
          "latitude {} longitude {} is too far from the map's UTM zone {}{}: check the position, or use another map",
          point.lat_deg, point.lon_deg, number_, northern_ ? 'N' : 'S'));
}

LatLon UtmZone::unproject(GridPoint point) const { return reverse(*this, point).position; }

Angle UtmZone::convergence(GridPoint point) const { return reverse(*this, point).convergence; }

}  // namespace roadfix
