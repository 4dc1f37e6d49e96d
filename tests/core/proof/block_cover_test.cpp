#include "core/proof/block_cover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/proof/bound_map.hpp"

namespace roadfix {
namespace {

constexpr CellOffset kNadir{10, 10};

/// A disc around the nadir with a hole, cut off on one side.
CellArray footprint(int radius) {
  CellArray cells(2 * kNadir.col + 1, 2 * kNadir.row + 1);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      const int east = col - kNadir.col;
      const int south = row - kNadir.row;
      const bool hole = east > 2 && east < 5 && south > -4 && south < 0;
      if (east * east + south * south <= radius * radius && east < 8 && !hole) cells.at(col, row) = kNoRoad;
    }
  }
  return cells;
}

/// Cells of the block that the footprint covers with its nadir at that position of its own block.
int covered_cells(const CellArray& cells, CellOffset position, CellOffset block) {
  int covered = 0;
  for (int i = 0; i < kBlockCells * kBlockCells; ++i) {
    const int col = kNadir.col - position.col + kBlockCells * block.col + i % kBlockCells;
    const int row = kNadir.row - position.row + kBlockCells * block.row + i / kBlockCells;
    const bool within = col >= 0 && row >= 0 && col < cells.cols() && row < cells.rows();
    covered += within && is_observed(cells.at(col, row)) ? 1 : 0;
  }
  return covered;
}

BlockCover counted(const CellArray& cells, int side) {
  BlockCover cover{side, {}, {}};
  for (int row = -side / 2; row <= side / 2; ++row) {
    for (int col = -side / 2; col <= side / 2; ++col) {
      bool all = true;
      bool any = false;
      for (int i = 0; i < kBlockCells * kBlockCells; ++i) {
        const int covered = covered_cells(cells, {i % kBlockCells, i / kBlockCells}, {col, row});
        all = all && covered == kBlockCells * kBlockCells;
        any = any || covered > 0;
      }
      cover.inner.push_back(all);
      cover.outer.push_back(any);
    }
  }
  return cover;
}

TEST(BlockCover, IsWhatAFootprintCoversFromEveryAndFromAnyPositionOfItsBlock) {
  for (const int radius : {0, 1, 5, 10}) {
    const CellArray cells = footprint(radius);
    const BlockCover cover = cover_of(cells, kNadir);
    const BlockCover expected = counted(cells, cover.side);
    EXPECT_EQ(cover.inner, expected.inner) << radius;
    EXPECT_EQ(cover.outer, expected.outer) << radius;
    const BlockCover wider = counted(cells, cover.side + 2);
    EXPECT_EQ(std::ranges::count(wider.outer, true), std::ranges::count(cover.outer, true)) << "nothing lies beyond it";
  }
}

TEST(BlockCover, InCommonIsWhatAllAndWhatAnyOfThemCover) {
  const BlockCover small{1, {true}, {true}};
  const BlockCover large{3,
                         {false, true, false, false, true, false, false, false, false},
                         {false, true, true, false, true, false, false, false, false}};
  const std::array both{&small, &large};
  const BlockCover common = common_cover(both);
  EXPECT_EQ(common.side, 3);
  EXPECT_EQ(common.inner, (std::vector<bool>{false, false, false, false, true, false, false, false, false}));
  EXPECT_EQ(common.outer, large.outer);
}

}  // namespace
}  // namespace roadfix
