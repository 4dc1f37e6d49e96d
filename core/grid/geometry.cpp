#include "core/grid/geometry.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace roadfix {

bool is_map_cell_size(double cell_m) {
  int exponent = 0;
  return cell_m >= kMinCellM && cell_m <= kMaxCellM && std::frexp(cell_m, &exponent) == 0.5;
}

GridGeometry GridGeometry::covering(const GridBox& box, double cell_m) {
  assert(cell_m > 0.0);
  const LatticeIndex first = lattice_index({box.min.east_m, box.max.north_m}, cell_m);
  const auto east = static_cast<int>(std::ceil(box.max.east_m / cell_m));
  const auto south = static_cast<int>(std::ceil(-box.min.north_m / cell_m));
  return {cell_m, first, std::max(0, east - first.col), std::max(0, south - first.row)};
}

GridBox GridGeometry::box() const {
  return {{origin.col * cell_m, -(origin.row + rows) * cell_m}, {(origin.col + cols) * cell_m, -origin.row * cell_m}};
}

GridPoint GridGeometry::cell_center(int col, int row) const { return point_at({col + 0.5, row + 0.5}); }

GridGeometry::CellPosition GridGeometry::position_of(GridPoint point) const {
  return {point.east_m / cell_m - origin.col, -point.north_m / cell_m - origin.row};
}

GridPoint GridGeometry::point_at(CellPosition position) const {
  return {(origin.col + position.col) * cell_m, -(origin.row + position.row) * cell_m};
}

GridGeometry GridGeometry::padded(int margin_cells) const {
  return {
      cell_m, {origin.col - margin_cells, origin.row - margin_cells}, cols + 2 * margin_cells, rows + 2 * margin_cells};
}

std::optional<GridGeometry> GridGeometry::intersection(const GridGeometry& other) const {
  assert(cell_m == other.cell_m);
  const int west = std::max(origin.col, other.origin.col);
  const int north = std::max(origin.row, other.origin.row);
  const int east = std::min(origin.col + cols, other.origin.col + other.cols);
  const int south = std::min(origin.row + rows, other.origin.row + other.rows);
  if (east <= west || south <= north) return std::nullopt;
  return GridGeometry{cell_m, {west, north}, east - west, south - north};
}

}  // namespace roadfix
