#include "core/grid/cell_array.hpp"

#include <algorithm>

namespace roadfix {

CellArray::CellArray(int cols, int rows, Cell fill)
    : cols_(cols), rows_(rows), cells_(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows), fill) {
  assert(cols >= 0 && rows >= 0);
}

std::size_t CellArray::observed_count() const {
  return cells_.size() - static_cast<std::size_t>(std::count(cells_.begin(), cells_.end(), kUnobserved));
}

bool CellArray::any_observed() const { return std::ranges::any_of(cells_, is_observed); }

void paste(const CellArray& source, CellArray& target, int col, int row) {
  const int first_col = std::max(0, -col);
  const int last_col = std::min(source.cols(), target.cols() - col);
  if (first_col >= last_col) return;
  const int last_row = std::min(source.rows(), target.rows() - row);
  for (int r = std::max(0, -row); r < last_row; ++r) {
    const auto from =
        source.row(r).subspan(static_cast<std::size_t>(first_col), static_cast<std::size_t>(last_col - first_col));
    std::ranges::copy(from, target.row(row + r).begin() + (col + first_col));
  }
}

}  // namespace roadfix
