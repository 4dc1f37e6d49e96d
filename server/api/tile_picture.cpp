#include "server/api/tile_picture.hpp"

#include <cmath>
#include <numbers>

#include "server/api/tile_ground.hpp"
#include "server/api/tile_painting.hpp"

namespace roadfix::api {
namespace {

constexpr double kMaxSourceCellM = 4096.0;

double level_cell_near(const MapView& map, double pixel_m) {
  double cell_m = map.cell_m;
  while (cell_m * std::numbers::sqrt2 <= pixel_m && 2.0 * cell_m <= kMaxSourceCellM) cell_m *= 2.0;
  return cell_m;
}

/// Bilinear over the observed neighbours; nullopt where the cell that holds the point is unobserved.
std::optional<double> sample(const RoadGrid& grid, GridPoint point) {
  if (!is_observed(grid.cell_at(point))) return std::nullopt;
  const auto position = grid.geometry.position_of(point);
  const double x = position.col - 0.5;
  const double y = position.row - 0.5;
  const int col = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(std::floor(y));
  double sum = 0.0;
  double weight = 0.0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const Cell cell = grid.cells.get(col + i, row + j);
      if (!is_observed(cell)) continue;
      const double w = (i == 0 ? 1.0 - (x - col) : x - col) * (j == 0 ? 1.0 - (y - row) : y - row);
      sum += w * probability(cell);
      weight += w;
    }
  }
  return weight > 0.0 ? std::optional(sum / weight) : std::nullopt;
}

Pixel road_pixel(double p, TileStyle style) {
  if (style == TileStyle::kGrey) return grey_pixel(p);
  const auto between = [&](double open, double road) {
    return static_cast<unsigned char>(std::lround(open + p * (road - open)));
  };
  return {between(60, 0), between(44, 176), between(40, 255), between(50, 235)};  // blue, green, red, alpha
}

}  // namespace

std::optional<std::vector<std::uint8_t>> tile_png(const MapView& map, TileAddress tile, TileStyle style) {
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
  if (grid.cells.observed_count() == 0) return std::nullopt;

  return painted_tile(ground, box, [&](GridPoint point) -> std::optional<Pixel> {
    const auto p = sample(grid, point);
    return p ? std::optional(road_pixel(*p, style)) : std::nullopt;
  });
}

int native_zoom(const MapView& map) {
  const LatLon middle = map.zone.unproject(map.extent.centre());
  int zoom = 0;
  while (zoom < kMaxZoom && metres_per_pixel(middle.lat_deg, zoom) > map.cell_m) ++zoom;
  return zoom;
}

}  // namespace roadfix::api
