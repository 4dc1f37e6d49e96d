// How cells are read between cells: what resampling and combining grids share.
#pragma once

#include "core/grid/cell_array.hpp"
#include "core/grid/geometry.hpp"

namespace roadfix {

/// Accumulates observed cells by weight; unobserved ones only count as missing.
class WeightedMean {
 public:
  void add(Cell cell, double weight) {
    total_ += weight;
    if (!is_observed(cell)) return;
    observed_ += weight;
    sum_ += weight * cell;
  }
  Cell cell() const {
    if (observed_ <= 0.0 || observed_ < 0.5 * total_) return kUnobserved;
    return static_cast<Cell>(sum_ / observed_ + 0.5);
  }

 private:
  double sum_ = 0.0;
  double observed_ = 0.0;
  double total_ = 0.0;
};

/// Mean of the four cells around a continuous position, weighted by nearness; unobserved where less than half of the
/// weight was observed.
Cell bilinear(const CellArray& cells, GridGeometry::CellPosition p);

/// Linear map from result cells to source cells: source = origin + col * right + row * down.
struct Placement {
  GridGeometry::CellPosition origin;
  GridGeometry::CellPosition right;
  GridGeometry::CellPosition down;
  GridGeometry::CellPosition source_of(double col, double row) const {
    return {origin.col + col * right.col + row * down.col, origin.row + col * right.row + row * down.row};
  }
};

}  // namespace roadfix
