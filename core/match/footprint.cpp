#include "core/match/footprint.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/grid/resample.hpp"

namespace roadfix {

Footprint::Footprint(const FeatureMap& north_up) {
  const CellArray& cells = north_up.cells;
  assert(cells.cols() <= kMaxCols);
  const int nadir_col = static_cast<int>(std::floor(north_up.nadir.col));
  const int nadir_row = static_cast<int>(std::floor(north_up.nadir.row));
  for (int r = 0; r < cells.rows(); ++r) {
    const auto row = cells.row(r);
    const auto first = std::ranges::find_if(row, is_observed);
    if (first == row.end()) continue;
    const auto last = std::find_if(row.rbegin(), row.rend(), is_observed).base();
    const auto length = static_cast<std::size_t>(last - first);
    const int first_col = static_cast<int>(first - row.begin()) - nadir_col;
    rows_.push_back({first_col, r - nadir_row, static_cast<int>(length), values_.size() * kAlignment});
    const std::size_t first_block = values_.size();
    values_.resize(first_block + (length + kAlignment - 1) / kAlignment);
    mask_.resize(values_.size());
    for (std::size_t i = 0; i < length; ++i) {
      const Cell cell = first[static_cast<std::ptrdiff_t>(i)];
      if (!is_observed(cell)) continue;
      values_[first_block + i / kAlignment].cells[i % kAlignment] = cell;
      mask_[first_block + i / kAlignment].cells[i % kAlignment] = 255;
      ++observed_cells_;
      sum_ += cell;
      sum_of_squares_ += std::int64_t{cell} * cell;
    }
    const int last_col = first_col + static_cast<int>(length) - 1;
    reach_ = std::max({reach_, std::abs(first_col), std::abs(last_col), std::abs(r - nadir_row)});
  }
}

Footprint footprint_at(const FeatureMap& map, Angle grid_heading, GridGeometry::CellPosition offset) {
  // A nadir that lies off the cell centre is a feature map whose centre lies off its nadir the other way, in the body
  // frame.
  FeatureMap shifted = map;
  const double c = cos(grid_heading);
  const double s = sin(grid_heading);
  shifted.nadir.col -= c * offset.col + s * offset.row;
  shifted.nadir.row -= -s * offset.col + c * offset.row;
  return Footprint(rotated(shifted, grid_heading));
}

}  // namespace roadfix
