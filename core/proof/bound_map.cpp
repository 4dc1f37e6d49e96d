#include "core/proof/bound_map.hpp"

#include <algorithm>

namespace roadfix {
namespace {

int blocks(int cells) { return (cells + kBlockCells - 1) / kBlockCells; }

/// Observed cells less `base`, others 0.
CellArray above_base(const CellArray& cells, int base) {
  CellArray above(cells.cols(), cells.rows(), 0);
  for (std::size_t i = 0; i < cells.cells().size(); ++i) {
    if (is_observed(cells.cells()[i])) above.cells()[i] = static_cast<Cell>(cells.cells()[i] - base);
  }
  return above;
}

/// The maximum of each cell and those `apart` to the right, below, and both: maxima of squares twice as large.
CellArray pooled_once(const CellArray& cells, int apart) {
  CellArray wide(cells.cols(), cells.rows(), 0);
  for (int row = 0; row < cells.rows(); ++row) {
    const auto in = cells.row(row);
    const auto out = wide.row(row);
    std::ranges::copy(in, out.begin());
    for (std::size_t col = 0; col + static_cast<std::size_t>(apart) < in.size(); ++col) {
      out[col] = std::max(in[col], in[col + static_cast<std::size_t>(apart)]);
    }
  }
  CellArray result = wide;
  for (int row = 0; row + apart < cells.rows(); ++row) {
    const auto next = wide.row(row + apart);
    const auto out = result.row(row);
    for (std::size_t col = 0; col < out.size(); ++col) out[col] = std::max(out[col], next[col]);
  }
  return result;
}

int min_observed(const CellArray& cells) {
  int min = kRoad;
  for (const Cell cell : cells.cells()) min = std::min<int>(min, is_observed(cell) ? cell : kRoad);
  return min;
}

int max_observed(const CellArray& cells) {
  int max = 0;
  for (const Cell cell : cells.cells()) max = std::max<int>(max, is_observed(cell) ? cell : 0);
  return max;
}

/// What the piece matches with its middle at each cell of a row; nothing beyond the map.
void sum_along_row(const CellArray& above, int row, const std::vector<CellOffset>& piece,
                   std::vector<std::uint16_t>& sums) {
  std::ranges::fill(sums, std::uint16_t{0});
  for (const CellOffset cell : piece) {
    const int from = row + cell.row;
    if (from < 0 || from >= above.rows()) continue;
    const int first = std::max(0, -cell.col);
    const int last = std::min(above.cols(), above.cols() - cell.col);
    const Cell* in = above.row(from).data() + cell.col;
    for (int col = first; col < last; ++col) sums[static_cast<std::size_t>(col)] += in[col];
  }
}

/// The maximum over the window of every block of a row.
void max_of_windows(const std::vector<std::uint16_t>& cells, std::vector<std::uint16_t>& blocks) {
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const std::uint16_t* first = cells.data() + block * kBlockCells;
    std::uint16_t max = 0;
    for (int i = 0; i < kBlockWindow; ++i) max = std::max(max, first[i]);
    blocks[block] = max;
  }
}

}  // namespace

BoundMap::BoundMap(const RoadGrid& grid, const Deadline& deadline)
    : geometry_(grid.geometry),
      block_cols_(blocks(grid.cells.cols())),
      block_rows_(blocks(grid.cells.rows())),
      stride_(block_cols_ + 2 * kMargin + kRun),
      base_(min_observed(grid.cells)),
      span_(std::max(1, max_observed(grid.cells) - base_)),
      exact_(grid.cells),
      pooled2_(CellArray()),
      pooled4_(CellArray()) {
  const auto size = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(block_rows_ + 2 * kMargin + 1) + kRun;
  planes_.assign(kPlanes, std::vector<std::uint8_t>(size, 0));
  for (auto* sums : {&cells_, &value_, &square_}) sums->assign(size, 0);
  const CellArray above = above_base(grid.cells, base_);
  const CellArray two = pooled_once(above, 1);
  pooled2_ = MapPlane(two);
  pooled4_ = MapPlane(pooled_once(two, 2));
  for (int i = 0; i < kLineDirections; ++i) {
    if (deadline.ended()) throw TimeIsOver();
    fill_piece_plane(i, line_stencil(i), above);
  }
  fill_piece_plane(kCellPlane, {{0, 0}}, above);
  fill_observed(grid.cells);
  fill_sums(grid.cells);
}

std::size_t BoundMap::bytes() const {
  std::size_t bytes = exact_.bytes() + pooled2_.bytes() + pooled4_.bytes();
  for (const auto& plane : planes_) bytes += plane.size();
  return bytes + (cells_.size() + value_.size() + square_.size()) * sizeof(std::uint32_t);
}

void BoundMap::fill_piece_plane(int index, const std::vector<CellOffset>& piece, const CellArray& above) {
  std::vector<std::uint16_t> sums(static_cast<std::size_t>(block_cols_ * kBlockCells + kBlockWindow));
  std::vector<std::uint16_t> best_of_row(static_cast<std::size_t>(block_cols_));
  std::vector<std::uint16_t> best(best_of_row.size() * static_cast<std::size_t>(block_rows_), 0);
  for (int row = 0; row < above.rows(); ++row) {
    sum_along_row(above, row, piece, sums);
    max_of_windows(sums, best_of_row);
    // Windows overlap: a row counts for its own block row and, but for a block's last row, for the block row above.
    for (int block_row = std::max(0, (row - kBlockWindow + kBlockCells) / kBlockCells); block_row <= row / kBlockCells;
         ++block_row) {
      auto* out = best.data() + static_cast<std::ptrdiff_t>(block_row) * block_cols_;
      for (std::size_t i = 0; i < best_of_row.size(); ++i) out[i] = std::max(out[i], best_of_row[i]);
    }
  }
  const int whole = static_cast<int>(piece.size()) * span_;
  for (int row = 0; row < block_rows_; ++row) {
    const auto* in = best.data() + static_cast<std::ptrdiff_t>(row) * block_cols_;
    std::uint8_t* out = plane(index, 0, row);
    for (int col = 0; col < block_cols_; ++col) {
      out[col] = static_cast<std::uint8_t>((in[col] * kFull + whole - 1) / whole);  // a bound: rounded up
    }
  }
}

void BoundMap::fill_observed(const CellArray& cells) {
  CellArray seen(cells.cols(), cells.rows(), 0);
  for (std::size_t i = 0; i < cells.cells().size(); ++i) seen.cells()[i] = is_observed(cells.cells()[i]) ? 1 : 0;
  // Windows are small: their cells are simply counted, column by column.
  std::vector<int> count(static_cast<std::size_t>(cells.cols() + kBlockWindow));
  for (int block_row = 0; block_row < block_rows_; ++block_row) {
    std::ranges::fill(count, 0);
    for (int row = block_row * kBlockCells; row < std::min(cells.rows(), block_row * kBlockCells + kBlockWindow);
         ++row) {
      const auto in = seen.row(row);
      for (std::size_t col = 0; col < in.size(); ++col) count[col] += in[col];
    }
    for (int block = 0; block < block_cols_; ++block) {
      int sum = 0;
      for (int i = 0; i < kBlockWindow; ++i)
        sum += count[static_cast<std::size_t>(std::min(block * kBlockCells + i, cells.cols()))];
      *plane(kAllObserved, block, block_row) = sum == kBlockWindow * kBlockWindow ? kFull : 0;
      *plane(kAnyObserved, block, block_row) = sum > 0 ? kFull : 0;
    }
  }
}

void BoundMap::fill_sums(const CellArray& cells) {
  for (int block_row = 0; block_row < block_rows_; ++block_row) {
    const auto start = static_cast<std::size_t>((block_row + kMargin) * stride_);
    std::vector<std::array<std::uint32_t, 3>> sums(static_cast<std::size_t>(block_cols_));
    for (int row = block_row * kBlockCells; row < std::min(cells.rows(), (block_row + 1) * kBlockCells); ++row) {
      const auto in = cells.row(row);
      for (int col = 0; col < cells.cols(); ++col) {
        const Cell cell = in[static_cast<std::size_t>(col)];
        if (!is_observed(cell)) continue;
        auto& sum = sums[static_cast<std::size_t>(col / kBlockCells)];
        const auto value = static_cast<std::uint32_t>(cell - base_);
        sum[0] += 1;
        sum[1] += value;
        sum[2] += value * value;
      }
    }
    std::array<std::uint32_t, 3> before{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(stride_); ++i) {
      cells_[start + i] = before[0];
      value_[start + i] = before[1];
      square_[start + i] = before[2];
      if (i < kMargin || i - kMargin >= sums.size()) continue;
      for (std::size_t k = 0; k < 3; ++k) before[k] += sums[i - kMargin][k];
    }
  }
}

}  // namespace roadfix
