// Cells or blocks side by side.
#pragma once

#include <vector>

#include "core/proof/line_stencil.hpp"

namespace roadfix {

/// Relative to a middle: first <= column < end of a row.
struct RowRun {
  int row = 0;
  int first = 0;
  int end = 0;
};

/// Those of cols x rows that marked(col, row) is true of, relative to `middle`.
template <typename Marked>
std::vector<RowRun> runs_of(int cols, int rows, CellOffset middle, Marked marked) {
  std::vector<RowRun> runs;
  for (int row = 0; row < rows; ++row) {
    int first = -1;
    for (int col = 0; col <= cols; ++col) {
      const bool within = col < cols && marked(col, row);
      if (within && first < 0) first = col;
      if (!within && first >= 0) {
        runs.push_back({row - middle.row, first - middle.col, col - middle.col});
        first = -1;
      }
    }
  }
  return runs;
}

}  // namespace roadfix
