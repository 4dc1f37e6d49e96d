#include "core/match/footprint.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/grid/resample.hpp"

namespace roadfix {

Footprint::Footprint(const FeatureMap& north_up) {
  const CellArray& cells = north_up.cells;
  assert(cells.cols() <= kMaxCols);
  const int nadir_col = static_cast<int>(std::floor(north_up.nadir.col));
  const int nadir_row = static_cast<int>(std::floor(north_up.nadir.row));
  const std::size_t blocks_of_row = (static_cast<std::size_t>(cells.cols()) + kAlignment - 1) / kAlignment;
  values_.reserve(blocks_of_row * static_cast<std::size_t>(cells.rows()));
  mask_.reserve(values_.capacity());
  for (int r = 0; r < cells.rows(); ++r) {
    const auto row = cells.row(r);
    const auto first = std::ranges::find_if(row, is_observed);
    if (first == row.end()) continue;
    const auto last = std::find_if(row.rbegin(), row.rend(), is_observed).base();
    const int first_col = static_cast<int>(first - row.begin()) - nadir_col;
    const int last_col = first_col + static_cast<int>(last - first) - 1;
    rows_.push_back({first_col, r - nadir_row, last_col - first_col + 1, values_.size() * kAlignment});
    add_span({first, last});
    reach_ = std::max({reach_, std::abs(first_col), std::abs(last_col), std::abs(r - nadir_row)});
  }
}

void Footprint::add_span(std::span<const Cell> span) {
  const std::size_t first_block = values_.size();
  values_.resize(first_block + (span.size() + kAlignment - 1) / kAlignment);
  mask_.resize(values_.size());
  std::uint8_t* values = values_[first_block].cells;
  std::uint8_t* mask = mask_[first_block].cells;
  // Loops that compilers turn into vectors.
  for (std::size_t i = 0; i < span.size(); ++i) {
    mask[i] = is_observed(span[i]) ? 255 : 0;
    values[i] = span[i] & mask[i];
  }
  std::uint32_t observed = 0;
  std::uint32_t sum = 0;
  std::uint32_t squares = 0;
  static_assert(std::uint64_t{kMaxCols} * kRoad * kRoad <= std::numeric_limits<std::uint32_t>::max());
  for (std::size_t i = 0; i < span.size(); ++i) {
    const std::uint32_t value = values[i];
    observed += mask[i] & 1U;
    sum += value;
    squares += value * value;
  }
  observed_cells_ += observed;
  sum_ += sum;
  sum_of_squares_ += squares;
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
