#include "core/proof/block_cover.hpp"

#include <algorithm>
#include <cstddef>

#include "core/proof/bound_map.hpp"

namespace roadfix {
namespace {

/// Observed cells within squares of cells, by a table of sums.
class WindowCount {
 public:
  explicit WindowCount(const CellArray& cells)
      : cols_(cells.cols()), rows_(cells.rows()), sums_(static_cast<std::size_t>((cols_ + 1) * (rows_ + 1)), 0) {
    for (int row = 0; row < rows_; ++row) {
      for (int col = 0; col < cols_; ++col) {
        sum(col + 1, row + 1) =
            sum(col, row + 1) + sum(col + 1, row) - sum(col, row) + (is_observed(cells.at(col, row)) ? 1 : 0);
      }
    }
  }
  int within(int col, int row, int size) {
    const int c0 = std::clamp(col, 0, cols_);
    const int c1 = std::clamp(col + size, 0, cols_);
    const int r0 = std::clamp(row, 0, rows_);
    const int r1 = std::clamp(row + size, 0, rows_);
    return sum(c1, r1) - sum(c0, r1) - sum(c1, r0) + sum(c0, r0);
  }

 private:
  int& sum(int col, int row) { return sums_[static_cast<std::size_t>(row * (cols_ + 1) + col)]; }

  int cols_;
  int rows_;
  std::vector<int> sums_;
};

}  // namespace

BlockCover cover_of(const CellArray& cells, CellOffset nadir) {
  const int reach = std::max(nadir.col, nadir.row);
  const int half = (reach + kBlockCells - 1) / kBlockCells + 1;
  BlockCover cover;
  cover.side = 2 * half + 1;
  WindowCount count(cells);
  for (int row = -half; row <= half; ++row) {
    for (int col = -half; col <= half; ++col) {
      // The cells of the block as seen from the positions of the nadir's block.
      const int seen = count.within(nadir.col + kBlockCells * col - kBlockCells + 1,
                                    nadir.row + kBlockCells * row - kBlockCells + 1, kBlockWindow);
      cover.inner.push_back(seen == kBlockWindow * kBlockWindow);
      cover.outer.push_back(seen > 0);
    }
  }
  return cover;
}

BlockCover common_cover(std::span<const BlockCover* const> covers) {
  BlockCover common;
  for (const BlockCover* cover : covers) common.side = std::max(common.side, cover->side);
  common.inner.assign(static_cast<std::size_t>(common.side * common.side), true);
  common.outer.assign(common.inner.size(), false);
  for (const BlockCover* cover : covers) {
    const int inset = (common.side - cover->side) / 2;
    for (int row = 0; row < common.side; ++row) {
      for (int col = 0; col < common.side; ++col) {
        const int c = col - inset;
        const int r = row - inset;
        const bool within = c >= 0 && r >= 0 && c < cover->side && r < cover->side;
        const auto from = static_cast<std::size_t>(r * cover->side + c);
        const auto to = static_cast<std::size_t>(row * common.side + col);
        common.inner[to] = common.inner[to] && within && cover->inner[from];
        common.outer[to] = common.outer[to] || (within && cover->outer[from]);
      }
    }
  }
  return common;
}

}  // namespace roadfix
