#include "cli/fly/area.hpp"

namespace roadfix::fly {

MapView middle_of(const MapView& map, double side_m) {
  const GridPoint middle = map.extent.centre();
  MapView part = map;
  part.extent = intersection(map.extent, grown({middle, middle}, 0.5 * side_m));
  part.id.version += "-part";
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
