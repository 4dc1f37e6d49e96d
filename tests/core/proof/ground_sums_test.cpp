#include "core/proof/ground_sums.hpp"

#include <gtest/gtest.h>

#include "core/proof/bound_map.hpp"
#include "core/units/draws.hpp"
#include "tests/support/random_cells.hpp"

namespace roadfix {
namespace {

constexpr int kGroundSide = 48;  // of the map, cells

/// Noise with a hole that was not observed.
RoadGrid ground_with_a_hole() {
  std::mt19937_64 random(7);
  CellArray cells = testing::smooth_cells(random, kGroundSide, kGroundSide);
  paste(CellArray(9, 6), cells, 20, 14);
  return {{4.0, {0, 0}, kGroundSide, kGroundSide}, cells};
}

/// The same, cell by cell.
GroundRange counted(const RoadGrid& ground, const BoundMap& map, const std::vector<RowRun>& footprint, int block_col,
                    int block_row) {
  GroundRange range{{1e9, 0.0}, {1e9, 0.0}, 1e9, 0.0};
  const auto include = [](Interval& of, double sum) { of = {std::min(of.min, sum), std::max(of.max, sum)}; };
  for (int position = 0; position < kBlockCells * kBlockCells; ++position) {
    double cells = 0.0;
    double value = 0.0;
    double square = 0.0;
    for (const RowRun& run : footprint) {
      for (int i = run.first; i < run.end; ++i) {
        const int col = kBlockCells * block_col + position % kBlockCells + i;
        const int row = kBlockCells * block_row + position / kBlockCells + run.row;
        const bool within = col >= 0 && row >= 0 && col < kGroundSide && row < kGroundSide;
        if (!within || !is_observed(ground.cells.at(col, row))) continue;
        const double above = ground.cells.at(col, row) - map.base();
        cells += 1.0;
        value += above;
        square += above * above;
      }
    }
    include(range.cells, cells);
    include(range.value, value);
    range.square_min = std::min(range.square_min, square);
    range.mixed_max = std::max(range.mixed_max, map.span() * value - square);
  }
  return range;
}

TEST(GroundSums, AreThoseOfEveryCellBelowAFootprintAtEveryPositionOfABlock) {
  const RoadGrid ground = ground_with_a_hole();
  const BoundMap map(ground);
  const std::vector<RowRun> footprint{{-3, -2, 4}, {-2, -6, -1}, {-2, 1, 7}, {0, -5, 6}, {4, 0, 1}};
  constexpr int kReach = 7;
  const GroundSums sums(map, -kReach, -kReach, kGroundSide + 2 * kReach, kGroundSide + 2 * kReach);
  for (int block_row = 0; block_row < kGroundSide / kBlockCells; ++block_row) {
    for (int block_col = 0; block_col < kGroundSide / kBlockCells; ++block_col) {
      SCOPED_TRACE(::testing::Message() << block_col << ' ' << block_row);
      const GroundRange expected = counted(ground, map, footprint, block_col, block_row);
      const GroundRange range = sums.below(footprint, block_col, block_row);
      EXPECT_EQ(range.cells.min, expected.cells.min);
      EXPECT_EQ(range.cells.max, expected.cells.max);
      EXPECT_EQ(range.value.min, expected.value.min);
      EXPECT_EQ(range.value.max, expected.value.max);
      EXPECT_EQ(range.square_min, expected.square_min);
      EXPECT_EQ(range.mixed_max, expected.mixed_max);
    }
  }
}

}  // namespace
}  // namespace roadfix
