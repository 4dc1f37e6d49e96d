// How cells are read between cells: what resampling and combining grids share.
#pragma once

#include <cstdint>

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

/// A Placement of which the positions are rounded to 1/128 of a cell: whole numbers, the same on every processor.
class SnappedPlacement {
 public:
  static constexpr int kShareBits = 7;  ///< of a position within its cell
  static constexpr int kCellBits = 17;  ///< a cell is 2^17 of the numbers below
  /// The longest edge of a source: beyond that the numbers would not hold.
  static constexpr int kMaxCells = 12'000;

  explicit SnappedPlacement(const Placement& placement);

  /// Positions of cells in a row: those of the first one, from the middle of the cell before the source's first one on
  /// and half of 1/128 more, and what the next one adds.
  struct Run {
    std::int32_t col = 0, row = 0;
    std::int32_t col_step = 0, row_step = 0;
  };
  /// From the cell (col, row) of the result on, for cells_left(col) cells; its positions lie within some cells of the
  /// source.
  Run run_at(int col, int row) const;
  /// After so many the steps start anew from exact numbers: their errors add up to less than 1/1000 of a cell. So the
  /// position of a cell lies within 1/200 of a cell of placement.source_of() its middle.
  static int cells_left(int col) { return kRunCells - col % kRunCells; }

 private:
  static constexpr int kRunCells = 256;

  Placement placement_;
  std::int32_t col_step_, row_step_;
};

}  // namespace roadfix
