// Cells with unobserved ground around them, for footprints that reach beyond a map.
#pragma once

#include "core/grid/cell_array.hpp"

namespace roadfix::testing {

/// `margin` cells more on every side.
inline CellArray padded(const CellArray& cells, int margin) {
  CellArray wide(cells.cols() + 2 * margin, cells.rows() + 2 * margin);
  paste(cells, wide, margin, margin);
  return wide;
}

}  // namespace roadfix::testing
