#include "core/proof/ground_sums.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace roadfix {
namespace {

constexpr int kValueBits = 32;

void include(Interval& range, std::uint64_t sum) {
  const auto value = static_cast<double>(sum);
  range = {std::min(range.min, value), std::max(range.max, value)};
}

}  // namespace

GroundSums::GroundSums(const BoundMap& map, int col, int row, int cols, int rows)
    : col_(col), row_(row), stride_(cols + 1), span_(map.span()) {
  const MapPlane& cells = map.exact();
  before_.reserve(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows));
  for (int r = row; r < row + rows; ++r) {
    CellSums before;
    for (int c = col; c <= col + cols; ++c) {
      before_.push_back(before);
      if (r < 0 || c < 0 || r >= cells.rows() || c >= cells.cols() || !is_observed(*cells.at(c, r))) continue;
      const auto value = static_cast<std::uint64_t>(*cells.at(c, r) - map.base());
      before.cells_and_values += 1 + (value << kValueBits);
      before.squares += value * value;
    }
  }
}

GroundRange GroundSums::below(std::span<const RowRun> footprint, int block_col, int block_row) const {
  constexpr double kMax = std::numeric_limits<double>::max();
  GroundRange range{{kMax, 0.0}, {kMax, 0.0}, kMax, 0.0};
  for (int i = 0; i < kBlockCells; ++i) {
    const std::ptrdiff_t col = kBlockCells * block_col - col_;
    const std::ptrdiff_t row = kBlockCells * block_row + i - row_;
    std::array<CellSums, kBlockCells> positions;
    cell_sums(footprint, before_.data() + row * stride_ + col, stride_, positions);
    for (const CellSums& sums : positions) {
      include(range.cells, sums.cells_and_values & std::numeric_limits<std::uint32_t>::max());
      const std::uint64_t value = sums.cells_and_values >> kValueBits;
      include(range.value, value);
      const auto square = static_cast<double>(sums.squares);
      range.square_min = std::min(range.square_min, square);
      // Per position: the one with the largest sum of values need not be the one with the least sum of squares.
      const double mixed = span_ * static_cast<double>(value) - square;
      range.mixed_max = std::max(range.mixed_max, mixed);
    }
  }
  return range;
}

}  // namespace roadfix
