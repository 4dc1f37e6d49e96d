#include "core/grid/sampling.hpp"

namespace roadfix {

Cell bilinear(const CellArray& cells, GridGeometry::CellPosition p) {
  const double x = p.col - 0.5;
  const double y = p.row - 0.5;
  if (!(x > -1.0 && y > -1.0 && x < cells.cols() && y < cells.rows())) return kUnobserved;
  const int col = static_cast<int>(x + 1.0) - 1;  // floor, for x > -1
  const int row = static_cast<int>(y + 1.0) - 1;
  const double fx = x - col;
  const double fy = y - row;
  if (col >= 0 && row >= 0 && col + 1 < cells.cols() && row + 1 < cells.rows()) {
    // Most cells have four observed neighbours; turning feature maps is what a search spends its time on.
    const Cell* above = &cells.row(row)[static_cast<std::size_t>(col)];
    const Cell* below = above + cells.cols();
    if (is_observed(above[0]) && is_observed(above[1]) && is_observed(below[0]) && is_observed(below[1])) {
      const double upper = above[0] + fx * (above[1] - above[0]);
      const double lower = below[0] + fx * (below[1] - below[0]);
      return static_cast<Cell>(upper + fy * (lower - upper) + 0.5);
    }
  }
  WeightedMean mean;
  mean.add(cells.get(col, row), (1.0 - fx) * (1.0 - fy));
  mean.add(cells.get(col + 1, row), fx * (1.0 - fy));
  mean.add(cells.get(col, row + 1), (1.0 - fx) * fy);
  mean.add(cells.get(col + 1, row + 1), fx * fy);
  return mean.cell();
}

namespace {

constexpr double kCell = 1 << SnappedPlacement::kCellBits;
constexpr int kDroppedBits = SnappedPlacement::kCellBits - SnappedPlacement::kShareBits;

/// Rounded to the nearest; the shift makes the conversion round down below 0 too.
std::int32_t fixed(double cells) {
  constexpr std::int64_t kShift = std::int64_t{1} << 40;
  return static_cast<std::int32_t>(static_cast<std::int64_t>(cells * kCell + 0.5 + static_cast<double>(kShift)) -
                                   kShift);
}

}  // namespace

SnappedPlacement::SnappedPlacement(const Placement& placement)
    : placement_(placement), col_step_(fixed(placement.right.col)), row_step_(fixed(placement.right.row)) {}

SnappedPlacement::Run SnappedPlacement::run_at(int col, int row) const {
  const int into = col % kRunCells;
  const GridGeometry::CellPosition start = placement_.source_of(col - into + 0.5, row + 0.5);
  constexpr std::int32_t kHalf = 1 << (kDroppedBits - 1);
  return {fixed(start.col + 0.5) + kHalf + into * col_step_, fixed(start.row + 0.5) + kHalf + into * row_step_,
          col_step_, row_step_};
}

}  // namespace roadfix
