#include "tiles/export/one_side.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

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

/// As degrees of --bbox. Draws the side that lies at the meridian back until all of the cells do, whose plane is turned
/// against it; nullopt where none are left.
std::optional<std::string> option_for(const UtmZone& zone, const GridGeometry& region, GeoBox side) {
  constexpr double kStepDeg = 1e-4;
  constexpr int kTries = 10;
  for (int i = 0; i < kTries && !side.empty(); ++i) {
    const GridBox box = intersection(grid_box_around(zone, side, region.box()), region.box());
    if (box.empty()) return {};
    const GeoBox cells = turned_to(geo_box_around(zone, GridGeometry::covering(box, region.cell_m).box()), side);
    if (is_on_one_side(cells)) {
      return fmt::format("--bbox {:.4f},{:.4f},{:.4f},{:.4f}", side.south_west.lon_deg, side.south_west.lat_deg,
                         side.north_east.lon_deg, side.north_east.lat_deg);
    }
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

}  // namespace

void require_one_side(const UtmZone& zone, const GridGeometry& region) {
  const GeoBox box = geo_box_around(zone, region.box());
  if (is_on_one_side(box)) return;
  constexpr double kTurnDeg = 360.0;
  constexpr double kRoomDeg = 1e-4;  // for the rounding of their text
  const double shift_deg = box.south_west.lon_deg < -kMeridianDeg ? kTurnDeg : 0.0;
  const LatLon south_west{box.south_west.lat_deg - kRoomDeg, box.south_west.lon_deg + shift_deg - kRoomDeg};
  const LatLon north_east{box.north_east.lat_deg + kRoomDeg, box.north_east.lon_deg + shift_deg - kTurnDeg + kRoomDeg};
  std::vector<std::string> options;
  for (const GeoBox& side : {GeoBox{south_west, {north_east.lat_deg, kMeridianDeg}},
                             GeoBox{{south_west.lat_deg, -kMeridianDeg}, north_east}}) {
    if (const auto option = option_for(zone, region, side)) options.push_back(*option);
  }
  throw InvalidInput("region-across-antimeridian",
                     fmt::format("the cells of the region lie on both sides of 180 degrees, where Web-Mercator ends "
                                 "(those of a box that ends there do, since the meridian leans across them): export "
                                 "each side by itself ({}), or as .tif or .png",
                                 options.empty() ? "--bbox" : fmt::format("{}", fmt::join(options, " and "))));
}

}  // namespace roadfix
