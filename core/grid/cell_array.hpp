// A rectangle of cells without a place on Earth: row-major, row 0 first.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "core/grid/cell.hpp"

namespace roadfix {

class CellArray {
 public:
  CellArray() = default;
  /// All cells start as `fill`. Negative sizes are not allowed.
  CellArray(int cols, int rows, Cell fill = kUnobserved);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  bool empty() const { return cells_.empty(); }
  bool contains(int col, int row) const { return col >= 0 && row >= 0 && col < cols_ && row < rows_; }

  Cell& at(int col, int row) { return cells_[index(col, row)]; }
  Cell at(int col, int row) const { return cells_[index(col, row)]; }
  /// kUnobserved outside the rectangle.
  Cell get(int col, int row) const { return contains(col, row) ? at(col, row) : kUnobserved; }

  std::span<Cell> row(int r) { return std::span(cells_).subspan(index(0, r), static_cast<std::size_t>(cols_)); }
  std::span<const Cell> row(int r) const {
    return std::span(cells_).subspan(index(0, r), static_cast<std::size_t>(cols_));
  }
  std::span<Cell> cells() { return cells_; }
  std::span<const Cell> cells() const { return cells_; }

  std::size_t observed_count() const;
  bool any_observed() const;

  friend bool operator==(const CellArray&, const CellArray&) = default;

 private:
  std::size_t index(int col, int row) const {
    assert(row >= 0 && row < rows_ && col >= 0 && (col < cols_ || cols_ == 0));
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col);
  }

  int cols_ = 0;
  int rows_ = 0;
  std::vector<Cell> cells_;
};

/// Copies `source` into `target` with its first cell at (col, row) of the target; what falls outside is dropped.
void paste(const CellArray& source, CellArray& target, int col, int row);

}  // namespace roadfix
