// Where the pixels of a Web-Mercator tile lie in the metric grid of a map.
#pragma once

#include <vector>

#include "core/geodesy/geo_box.hpp"
#include "core/locate/map_view.hpp"
#include "tiles/mercator/web_mercator.hpp"

namespace roadfix::mercator {

/// Of the map's extent, which is not empty, as TileJSON and MBTiles may tell it: all around the Earth where it lies
/// across the antimeridian.
GeoBox bounds_of(const MapView& map);

/// Pixels of a tile [left, right) x [top, bottom).
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return left >= right || top >= bottom; }
};

/// The tiles of a zoom that touch a box of the plane, which is not empty.
std::vector<TileAddress> tiles_on(const UtmZone& zone, const GridBox& box, int zoom);

/// Those that the map's extent, which is not empty, touches.
PixelBox touched_pixels(const MapView& map, TileAddress tile);

/// Grid points of pixel centres, exact on a mesh and interpolated between: the projection is nearly linear over the
/// steps of the mesh (at worst 0.02 pixels off, at zoom 5). The mesh ends close to the box: far off its zone UTM is
/// undefined.
class PixelToGrid {
 public:
  /// `box` is not empty.
  PixelToGrid(const UtmZone& zone, TileAddress tile, const PixelBox& box);

  /// Of a pixel of the box.
  GridPoint at(int x, int y) const;
  GridBox box() const;

 private:
  int nodes(int pixels) const { return (pixels - 1) / step_ + 2; }
  const GridPoint& node(int i, int j) const { return points_[static_cast<std::size_t>(j * cols_ + i)]; }

  PixelBox box_;
  int step_;
  int cols_;
  int rows_;
  std::vector<GridPoint> points_;
};

}  // namespace roadfix::mercator
