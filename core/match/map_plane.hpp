// Map cells laid out for the matching kernel: rows with a margin of unobserved cells on every side, so that a footprint
// that is partly off the map needs no clipping.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/cell_array.hpp"

namespace roadfix {

class MapPlane {
 public:
  /// `margin` >= 0 cells: how far a footprint may reach beyond the cells.
  MapPlane(const CellArray& cells, int margin);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int margin() const { return margin_; }
  std::size_t bytes() const { return bytes_.size(); }
  std::ptrdiff_t stride() const { return stride_; }
  /// Cell (col, row); readable from -margin to size + margin, and kOverread bytes to the right of that.
  const std::uint8_t* at(int col, int row) const { return bytes_.data() + (row + margin_) * stride_ + (col + margin_); }

  /// Vectors may read past the end of a row by less than this.
  static constexpr int kOverread = 64;

 private:
  int cols_;
  int rows_;
  int margin_;
  std::ptrdiff_t stride_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace roadfix
