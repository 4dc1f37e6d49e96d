// Tiles of the Web-Mercator square (EPSG:3857, XYZ scheme: x from the antimeridian east, y from the north).
#pragma once

#include <compare>

#include "core/geodesy/latlon.hpp"

namespace roadfix::mercator {

inline constexpr int kTilePixels = 256;
inline constexpr int kMaxZoom = 24;

/// 0 <= z <= kMaxZoom, 0 <= x, y < 2^z.
struct TileAddress {
  int z = 0;
  int x = 0;
  int y = 0;
  friend auto operator<=>(const TileAddress&, const TileAddress&) = default;
};

/// Continuous pixel coordinates of the whole square at a zoom; the poles are at infinity.
struct MercatorPixel {
  double x = 0.0;
  double y = 0.0;
};
MercatorPixel mercator_pixel(LatLon at, int zoom);
/// Of any pixel, also beyond the square.
LatLon lat_lon(MercatorPixel pixel, int zoom);

/// Side of a pixel on the ground at that latitude, on the sphere that Web Mercator takes the Earth for.
double metres_per_pixel(double lat_deg, int zoom);

}  // namespace roadfix::mercator
