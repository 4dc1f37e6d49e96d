#include "core/match/quarter_planes.hpp"

#include <cassert>
#include <cmath>

#include "core/grid/resample.hpp"

namespace roadfix {

QuarterPlanes::QuarterPlanes(const CellArray& window, bool rotated) {
  planes_.emplace_back(window);
  if (!rotated) return;
  // To the left by three quarters, two and one: to the right by one more each time.
  CellArray cells = window;
  for (int k = 0; k < 3; ++k) {
    cells = quarter_turned(cells);
    planes_.emplace(planes_.begin() + 1, cells);
  }
}

PlaneCell QuarterPlanes::place(PlaneCell cell, int quarters) const {
  assert(quarters >= 0 && quarters < 4);
  const int to_the_right = planes_.front().cols() - 1 - cell.col;
  const int below = planes_.front().rows() - 1 - cell.row;
  switch (quarters) {
    case 0:
      return cell;
    case 1:
      return {cell.row, to_the_right};
    case 2:
      return {to_the_right, below};
    default:
      return {below, cell.col};
  }
}

bool worth_rotating(const GridGeometry& window, int reach, double footprints_spared) {
  // A cell of the window, rotated three times, costs three quarters of what one of a footprint does.
  const double footprint_cells = std::pow(2.0 * reach + 1.0, 2.0);
  return 4.0 * footprint_cells * footprints_spared > 3.0 * window.cols * window.rows;
}

}  // namespace roadfix
