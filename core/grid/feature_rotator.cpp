#include "core/grid/feature_rotator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roadfix {

FeatureRotator::FeatureRotator(const FeatureMap& map)
    : cols_(map.cells.cols()), rows_(map.cells.rows()), cell_m_(map.cell_m), nadir_(map.nadir), source_(map.cells) {}

FeatureMap FeatureRotator::rotated(Angle heading) const {
  const double c = cos(heading);
  const double s = sin(heading);
  // Farthest corner in each direction decides the size; body right = (c, s), body down = (-s, c) in (col, row).
  double half_cols = 0.5;
  double half_rows = 0.5;
  for (const GridGeometry::CellPosition corner :
       std::array<GridGeometry::CellPosition, 4>{{{0, 0}, {cols_, 0}, {0, rows_}, {cols_, rows_}}}) {
    const double right = corner.col - nadir_.col;
    const double down = corner.row - nadir_.row;
    half_cols = std::max(half_cols, std::abs(c * right - s * down));
    half_rows = std::max(half_rows, std::abs(s * right + c * down));
  }
  const int reach_cols = static_cast<int>(std::ceil(half_cols - 0.5 - 1e-9));
  const int reach_rows = static_cast<int>(std::ceil(half_rows - 0.5 - 1e-9));
  const GridGeometry::CellPosition centre{reach_cols + 0.5, reach_rows + 0.5};
  const Placement placement{
      {nadir_.col - c * centre.col - s * centre.row, nadir_.row + s * centre.col - c * centre.row}, {c, -s}, {s, c}};
  return {source_.sampled(placement, 2 * reach_cols + 1, 2 * reach_rows + 1), cell_m_, centre};
}

}  // namespace roadfix
