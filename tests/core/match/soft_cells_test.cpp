#include "core/match/soft_cells.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(SoftCells, HalveTheLogOdds) {
  const SoftCells soft(0.5);
  // 1 : 9 becomes 1 : 3, 1 : 1 stays.
  EXPECT_NEAR(probability(soft.of(cell_from_probability(0.1))), 0.25, 0.003);
  EXPECT_NEAR(probability(soft.of(cell_from_probability(0.9))), 0.75, 0.003);
  EXPECT_EQ(soft.of(127), 127);
}

TEST(SoftCells, LeaveTheCertainAndTheUnobservedAndKeepTheOrder) {
  const SoftCells soft(0.5);
  EXPECT_EQ(soft.of(kNoRoad), kNoRoad);
  EXPECT_EQ(soft.of(kRoad), kRoad);
  EXPECT_EQ(soft.of(kUnobserved), kUnobserved);
  for (int k = kNoRoad; k < kRoad; ++k) EXPECT_LE(soft.of(static_cast<Cell>(k)), soft.of(static_cast<Cell>(k + 1)));
}

TEST(SoftCells, OfTheWholeLogOddsAreTheCellsThemselves) {
  CellArray cells(256, 1);
  for (int k = 0; k < 256; ++k) cells.at(k, 0) = static_cast<Cell>(k);
  const CellArray before = cells;
  SoftCells(1.0).apply(cells);
  EXPECT_EQ(cells, before);
}

}  // namespace
}  // namespace roadfix
