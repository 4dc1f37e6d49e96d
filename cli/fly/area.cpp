#include "cli/fly/area.hpp"

#include <algorithm>

namespace roadfix::fly {

MapView middle_of(const MapView& map, double side_m) {
  const GridBox& all = map.extent;
  const GridPoint middle{0.5 * (all.min.east_m + all.max.east_m), 0.5 * (all.min.north_m + all.max.north_m)};
  const double half = 0.5 * side_m;
  MapView part = map;
  part.extent = {{std::max(all.min.east_m, middle.east_m - half), std::max(all.min.north_m, middle.north_m - half)},
                 {std::min(all.max.east_m, middle.east_m + half), std::min(all.max.north_m, middle.north_m + half)}};
  part.version += "-part";
  part.read = [read = map.read, box = part.extent](const GridGeometry& geometry) {
    RoadGrid grid = read(geometry);
    for (int row = 0; row < geometry.rows; ++row) {
      for (int col = 0; col < geometry.cols; ++col) {
        if (!box.contains(geometry.cell_center(col, row))) grid.cells.at(col, row) = kUnobserved;
      }
    }
    return grid;
  };
  return part;
}

}  // namespace roadfix::fly
