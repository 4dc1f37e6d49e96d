// Boxes of latitude and longitude, and the boxes of a zone's plane around them. The sides of either are curves in the
// other.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "core/units/grid_quad.hpp"

namespace roadfix {

/// Across the antimeridian one of the longitudes lies beyond 180 degrees: west is less than east.
struct GeoBox {
  LatLon south_west;
  LatLon north_east;

  /// Also where a number is NaN.
  bool empty() const {
    return !(south_west.lat_deg < north_east.lat_deg) || !(south_west.lon_deg < north_east.lon_deg);
  }
};

/// Of west, south, east and north in degrees, as people write them: longitudes are counted up to 180 or up to 360, and
/// where west lies more than half a turn above east the box crosses the meridian at which their count begins anew.
/// nullopt where they are no box of the Earth with ground in it.
std::optional<GeoBox> told_box(std::span<const double, 4> sides_deg);

/// The smallest one around a box of the plane, which is not empty, to centimetres for a city.
GeoBox geo_box_around(const UtmZone& zone, const GridBox& box);

/// The smallest box of the plane around what of the geographic one, which is not empty, lies within some kilometres of
/// `place` (UTM is not defined everywhere); empty where nothing does.
GridBox grid_box_around(const UtmZone& zone, const GeoBox& box, const GridBox& place);

/// What of the geographic box lies within some kilometres of `place`, which is not empty: its sides to centimetres for
/// a city and to metres for a country. None where nothing does; two where it comes from both sides around the Earth.
std::vector<GridQuad> grid_quads_of(const UtmZone& zone, const GeoBox& box, const GridBox& place);

}  // namespace roadfix
