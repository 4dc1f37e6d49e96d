#include "tiles/export/one_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/geodesy/geo_box.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr double kMeridianDeg = 180.0;

/// Longitudes that lie nearest to those of another box.
GeoBox turned_to(GeoBox box, const GeoBox& other) {
  constexpr double kTurnDeg = 360.0;
  const double turns = std::round((other.south_west.lon_deg - box.south_west.lon_deg) / kTurnDeg);
  box.south_west.lon_deg += turns * kTurnDeg;
  box.north_east.lon_deg += turns * kTurnDeg;
  return box;
}

bool is_on_one_side(const GeoBox& box) {
  return box.south_west.lon_deg >= -kMeridianDeg && box.north_east.lon_deg <= kMeridianDeg;
}

/// Draws the side that lies at the meridian back until all of the cells do, whose plane is turned against it; nullopt
/// where none are left.
std::optional<GeoBox> drawn_back(const UtmZone& zone, const GridGeometry& region, GeoBox side) {
  constexpr double kStepDeg = 1e-4;
  constexpr int kTries = 10;
  for (int i = 0; i < kTries && !side.empty(); ++i) {
    const GridBox box = intersection(grid_box_around(zone, side, region.box()), region.box());
    if (box.empty()) return {};
    const GeoBox cells = turned_to(geo_box_around(zone, GridGeometry::covering(box, region.cell_m).box()), side);
    if (is_on_one_side(cells)) return side;
    const double over_deg = std::max(-kMeridianDeg - cells.south_west.lon_deg, cells.north_east.lon_deg - kMeridianDeg);
    const double back_deg = std::ceil(over_deg / kStepDeg) * kStepDeg;
    if (side.south_west.lon_deg < 0.0) {
      side.south_west.lon_deg += back_deg;
    } else {
      side.north_east.lon_deg -= back_deg;
    }
  }
  return {};
}

std::string option_of(const GeoBox& side) {
  return fmt::format("--bbox {:.4f},{:.4f},{:.4f},{:.4f}", side.south_west.lon_deg, side.south_west.lat_deg,
                     side.north_east.lon_deg, side.north_east.lat_deg);
}

/// The ground that lies in neither.
double between_m(const UtmZone& zone, const GeoBox& west, const GeoBox& east) {
  return distance_m(zone.project({west.north_east.lat_deg, west.north_east.lon_deg}),
                    zone.project({west.north_east.lat_deg, east.south_west.lon_deg}));
}

/// How to export all of it.
std::string remedy(const UtmZone& zone, const std::optional<GeoBox>& west, const std::optional<GeoBox>& east) {
  constexpr const char* kWhole = "or as .tif or .png";
  if (west && east) {
    return fmt::format(
        "export each side by itself ({} and {}; a strip of {:.0f} m along the meridian is in neither), {}",
        option_of(*west), option_of(*east), between_m(zone, *west, *east), kWhole);
  }
  const std::optional<GeoBox>& only = west ? west : east;
  return fmt::format("export each side by itself ({}), {}", only ? option_of(*only) : "--bbox", kWhole);
}

}  // namespace

void require_one_side(const UtmZone& zone, const GridGeometry& region) {
  const GeoBox box = geo_box_around(zone, region.box());
  if (is_on_one_side(box)) return;
  constexpr double kTurnDeg = 360.0;
  constexpr double kRoomDeg = 1e-4;  // for the rounding of their text
  const double shift_deg = box.south_west.lon_deg < -kMeridianDeg ? kTurnDeg : 0.0;
  const LatLon south_west{box.south_west.lat_deg - kRoomDeg, box.south_west.lon_deg + shift_deg - kRoomDeg};
  const LatLon north_east{box.north_east.lat_deg + kRoomDeg, box.north_east.lon_deg + shift_deg - kTurnDeg + kRoomDeg};
  const auto west = drawn_back(zone, region, {south_west, {north_east.lat_deg, kMeridianDeg}});
  const auto east = drawn_back(zone, region, {{south_west.lat_deg, -kMeridianDeg}, north_east});
  throw InvalidInput("region-across-antimeridian",
                     fmt::format("the cells of the region lie on both sides of 180 degrees, where Web-Mercator ends "
                                 "(those of a box that ends there do, since the meridian leans across them): {}",
                                 remedy(zone, west, east)));
}

}  // namespace roadfix
