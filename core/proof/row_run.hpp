// Runs of neighbouring cells or blocks in a row.
#pragma once

#include <vector>

#include "core/proof/line_stencil.hpp"

namespace roadfix {

/// The columns first <= column < end of a row, relative to a middle cell.
struct RowRun {
  int row = 0;
  int first = 0;
  int end = 0;
};

/// The runs of all cells of cols x rows for which marked(col, row) is true, relative to `middle`.
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
