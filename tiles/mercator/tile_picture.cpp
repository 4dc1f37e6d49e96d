#include "tiles/mercator/tile_picture.hpp"

#include <cmath>
#include <numbers>

#include "tiles/mercator/tile_ground.hpp"
#include "tiles/mercator/tile_painting.hpp"

namespace roadfix::mercator {
namespace {

constexpr double kMaxSourceCellM = 4096.0;

int floored(double value) { return static_cast<int>(std::floor(value)); }

double level_cell_near(const MapView& map, double pixel_m) {
  double cell_m = map.cell_m;
  while (cell_m * std::numbers::sqrt2 <= pixel_m && 2.0 * cell_m <= kMaxSourceCellM) cell_m *= 2.0;
  return cell_m;
}

/// Of the cells, 0..254, bilinear over the observed neighbours; nullopt where the cell that holds the point is
/// unobserved.
std::optional<double> sample(const RoadGrid& grid, GridPoint point) {
  const auto position = grid.geometry.position_of(point);
  if (!is_observed(grid.cells.get(floored(position.col), floored(position.row)))) return std::nullopt;
  const double x = position.col - 0.5;
  const double y = position.row - 0.5;
  const int col = floored(x);
  const int row = floored(y);
  const Cell north_west = grid.cells.get(col, row);
  const Cell north_east = grid.cells.get(col + 1, row);
  const Cell south_west = grid.cells.get(col, row + 1);
  const Cell south_east = grid.cells.get(col + 1, row + 1);
  if (north_west == north_east && north_west == south_west && north_west == south_east) return north_west;
  const double east = x - col;
  const double south = y - row;
  double sum = 0.0;
  double weight = 0.0;
  const auto add = [&](Cell cell, double share) {
    if (!is_observed(cell)) return;
    sum += share * cell;
    weight += share;
  };
  add(north_west, (1.0 - east) * (1.0 - south));
  add(north_east, east * (1.0 - south));
  add(south_west, (1.0 - east) * south);
  add(south_east, east * south);
  return weight > 0.0 ? std::optional(sum / weight) : std::nullopt;
}

Pixel road_pixel(double cell, TileStyle style) {
  if (style == TileStyle::kGrey) return grey_pixel(cell);
  const auto between = [share = cell / kRoad](double open, double road) {
    return static_cast<std::uint8_t>(std::lround(std::lerp(open, road, share)));
  };
  return {between(40, 255), between(44, 176), between(60, 0), between(50, 235)};  // red, green, blue, alpha
}

}  // namespace

std::optional<std::vector<std::byte>> tile_png(const MapView& map, TileAddress tile, TileStyle style) {
  if (map.extent.empty()) return std::nullopt;
  const PixelBox box = touched_pixels(map, tile);
  if (box.empty()) return std::nullopt;
  const PixelToGrid ground(map.zone, tile, box);
  const double middle_y = double{kTilePixels} * tile.y + 0.5 * (box.top + box.bottom);
  const double pixel_m = metres_per_pixel(lat_lon({0.0, middle_y}, tile.z).lat_deg, tile.z);
  const double cell_m = level_cell_near(map, pixel_m);
  const GridBox needed = grown(intersection(ground.box(), map.extent), 2.0 * cell_m);
  if (needed.empty()) return std::nullopt;
  const RoadGrid grid = map.read(GridGeometry::covering(needed, cell_m));
  if (!grid.cells.any_observed()) return std::nullopt;

  return painted_tile(ground, box, [&](GridPoint point) -> std::optional<Pixel> {
    const auto cell = sample(grid, point);
    return cell ? std::optional(road_pixel(*cell, style)) : std::nullopt;
  });
}

int native_zoom(const MapView& map) {
  const LatLon middle = map.zone.unproject(map.extent.centre());
  int zoom = 0;
  while (zoom < kMaxZoom && metres_per_pixel(middle.lat_deg, zoom) > map.cell_m) ++zoom;
  return zoom;
}

}  // namespace roadfix::mercator
