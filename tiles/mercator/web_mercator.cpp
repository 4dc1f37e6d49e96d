#include "tiles/mercator/web_mercator.hpp"

#include <cmath>
#include <numbers>

namespace roadfix::mercator {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEquatorM = 40'075'016.685578488;  // 2 pi 6378137, the sphere of EPSG:3857

double world_pixels(int zoom) { return kTilePixels * std::exp2(zoom); }

}  // namespace

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

}  // namespace roadfix::mercator
