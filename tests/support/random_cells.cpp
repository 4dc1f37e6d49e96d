#include "tests/support/random_cells.hpp"

#include <algorithm>

namespace roadfix::testing {

CellArray random_cells(std::mt19937_64& random, int cols, int rows, double unobserved) {
  CellArray cells(cols, rows);
  for (Cell& cell : cells.cells()) {
    const bool hidden = static_cast<double>(random() % 1000) < 1000.0 * unobserved;
    cell = hidden ? kUnobserved : static_cast<Cell>(random() % 255);
  }
  return cells;
}

CellArray smooth_cells(std::mt19937_64& random, int cols, int rows) {
  const CellArray noise = random_cells(random, cols + 4, rows + 4, 0.0);
  CellArray smooth(cols, rows);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      int sum = 0;
      for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 5; ++i) sum += noise.at(col + i, row + j);
      }
      smooth.at(col, row) = static_cast<Cell>(std::clamp((sum / 25 - 127) * 4 + 127, 0, 254));
    }
  }
  return smooth;
}

}  // namespace roadfix::testing
