#include "server/api/web_mercator.hpp"

#include <cmath>
#include <numbers>

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::api {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEquatorM = 40'075'016.685578488;  // 2 pi 6378137, the sphere of EPSG:3857

int parse_index(const std::string& text, int end) {
  const auto value = as_number<int>(text);
  if (!value || *value < 0 || *value >= end || std::to_string(*value) != text) {  // 7 and 007 would be one tile
    throw NotFound("tile-not-found",
                   "tiles are /{z}/{x}/{y}.png with z from 0 to 24 and x, y from 0 to 2^z - 1, without leading zeros");
  }
  return *value;
}

double world_pixels(int zoom) { return kTilePixels * std::exp2(zoom); }

}  // namespace

TileAddress parse_tile(const std::string& z, const std::string& x, const std::string& y) {
  const int zoom = parse_index(z, kMaxZoom + 1);
  return {zoom, parse_index(x, 1 << zoom), parse_index(y, 1 << zoom)};
}

MercatorPixel mercator_pixel(LatLon at, int zoom) {
  const double lat = at.lat_deg * kPi / 180.0;
  const double size = world_pixels(zoom);
  return {(at.lon_deg + 180.0) / 360.0 * size, (1.0 - std::asinh(std::tan(lat)) / kPi) / 2.0 * size};
}

LatLon lat_lon(MercatorPixel pixel, int zoom) {
  const double size = world_pixels(zoom);
  return {std::atan(std::sinh(kPi * (1.0 - 2.0 * pixel.y / size))) * 180.0 / kPi, pixel.x / size * 360.0 - 180.0};
}

double metres_per_pixel(double lat_deg, int zoom) {
  return kEquatorM * std::cos(lat_deg * kPi / 180.0) / world_pixels(zoom);
}

}  // namespace roadfix::api
