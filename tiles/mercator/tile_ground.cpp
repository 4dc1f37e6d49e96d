#include "tiles/mercator/tile_ground.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix::mercator {
namespace {

constexpr int kLongestStep = 16;

PixelBox pixels_of(const GeoBox& bounds, TileAddress tile, double turn_deg) {
  const MercatorPixel north_west =
      mercator_pixel({bounds.north_east.lat_deg, bounds.south_west.lon_deg + turn_deg}, tile.z);
  const MercatorPixel south_east =
      mercator_pixel({bounds.south_west.lat_deg, bounds.north_east.lon_deg + turn_deg}, tile.z);
  const auto within = [](double value) { return static_cast<int>(std::clamp(value, 0.0, double{kTilePixels})); };
  const double x0 = double{kTilePixels} * tile.x;
  const double y0 = double{kTilePixels} * tile.y;
  return {within(std::floor(north_west.x - x0)), within(std::floor(north_west.y - y0)),
          within(std::ceil(south_east.x - x0)), within(std::ceil(south_east.y - y0))};
}

}  // namespace

GeoBox bounds_of(const MapView& map) {
  const GeoBox box = geo_box_around(map.zone, map.extent);
  if (box.south_west.lon_deg >= -180.0 && box.north_east.lon_deg <= 180.0) return box;
  return {{box.south_west.lat_deg, -180.0}, {box.north_east.lat_deg, 180.0}};
}

std::vector<TileAddress> tiles_on(const UtmZone& zone, const GridBox& box, int zoom) {
  const GeoBox bounds = geo_box_around(zone, box);
  const MercatorPixel north_west = mercator_pixel({bounds.north_east.lat_deg, bounds.south_west.lon_deg}, zoom);
  const MercatorPixel south_east = mercator_pixel({bounds.south_west.lat_deg, bounds.north_east.lon_deg}, zoom);
  const auto tile_of = [](double pixel) { return static_cast<int>(std::floor(pixel / kTilePixels)); };
  const int across = 1 << zoom;
  std::vector<TileAddress> tiles;
  for (int y = std::max(0, tile_of(north_west.y)); y <= std::min(across - 1, tile_of(south_east.y)); ++y) {
    for (int x = tile_of(north_west.x); x <= tile_of(south_east.x); ++x) {
      tiles.push_back({zoom, (x % across + across) % across, y});  // beyond the antimeridian it begins anew
    }
  }
  return tiles;
}

PixelBox touched_pixels(const MapView& map, TileAddress tile) {
  const GeoBox bounds = geo_box_around(map.zone, map.extent);
  for (const double turn_deg : {0.0, 360.0, -360.0}) {
    const PixelBox box = pixels_of(bounds, tile, turn_deg);
    if (!box.empty()) return box;
  }
  return {};
}

PixelToGrid::PixelToGrid(const UtmZone& zone, TileAddress tile, const PixelBox& box)
    : box_(box),
      step_(std::min(kLongestStep, std::max(box.right - box.left, box.bottom - box.top))),
      cols_(nodes(box.right - box.left)),
      rows_(nodes(box.bottom - box.top)) {
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < cols_; ++i) {
      const MercatorPixel pixel{double{kTilePixels} * tile.x + box.left + i * step_ + 0.5,
                                double{kTilePixels} * tile.y + box.top + j * step_ + 0.5};
      points_.push_back(zone.project(lat_lon(pixel, tile.z)));
    }
  }
}

GridPoint PixelToGrid::at(int x, int y) const {
  const int i = (x - box_.left) / step_;
  const int j = (y - box_.top) / step_;
  const double u = static_cast<double>(x - box_.left - i * step_) / step_;
  const double v = static_cast<double>(y - box_.top - j * step_) / step_;
  const GridPoint& north_west = node(i, j);
  const GridPoint& north_east = node(i + 1, j);
  const GridPoint& south_west = node(i, j + 1);
  const GridPoint& south_east = node(i + 1, j + 1);
  const auto blend = [u, v](double nw, double ne, double sw, double se) {
    return (1.0 - v) * ((1.0 - u) * nw + u * ne) + v * ((1.0 - u) * sw + u * se);
  };
  return {blend(north_west.east_m, north_east.east_m, south_west.east_m, south_east.east_m),
          blend(north_west.north_m, north_east.north_m, south_west.north_m, south_east.north_m)};
}

GridBox PixelToGrid::box() const { return box_around(points_); }

}  // namespace roadfix::mercator
