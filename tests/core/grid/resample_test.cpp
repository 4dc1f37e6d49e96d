#include "core/grid/resample.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/ascii_map.hpp"
#include "tests/support/random_cells.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;
using testing::to_ascii;

TEST(Halved, AveragesOnlyWhatWasObserved) {
  EXPECT_EQ(to_ascii(halved(from_ascii("##.. "
                                       "##.# "
                                       "?#?? "
                                       "???? "))),
            "#2\n#?\n");
}

TEST(Rotated, QuarterTurnEastPutsForwardToTheRight) {
  const FeatureMap map = FeatureMap::centred(from_ascii("### "
                                                        "... "
                                                        "... "),
                                             2.0);
  EXPECT_EQ(to_ascii(rotated(map, Angle::degrees(90)).cells), "..#\n..#\n..#\n");
  EXPECT_EQ(to_ascii(rotated(map, Angle::degrees(180)).cells), "...\n...\n###\n");
  EXPECT_EQ(to_ascii(rotated(map, Angle::degrees(-90)).cells), "#..\n#..\n#..\n");
}

TEST(Rotated, LeavesCornersUnobserved) {
  const FeatureMap map = FeatureMap::centred(CellArray(21, 21, kRoad), 1.0);
  const FeatureMap turned = rotated(map, Angle::degrees(45));
  EXPECT_EQ(turned.cells.get(0, 0), kUnobserved);
  EXPECT_EQ(turned.cells.get(turned.cells.cols() / 2, turned.cells.rows() / 2), kRoad);
  EXPECT_NEAR(static_cast<double>(turned.cells.observed_count()), 441.0, 25.0);
}

TEST(QuarterTurned, IsTheMapTurnedByNinetyDegreesMore) {
  const FeatureMap map{from_ascii("##.# "
                                  "..#. "
                                  "?.## "),
                       2.0,
                       {1.5, 0.5}};
  const FeatureMap turned = rotated(map, Angle::degrees(90));
  EXPECT_EQ(quarter_turned(rotated(map, Angle())), turned);
  EXPECT_EQ(quarter_turned(turned), rotated(map, Angle::degrees(180)));
  const FeatureMap east = quarter_turned(map);
  EXPECT_EQ(to_ascii(east.cells), "?.#\n..#\n##.\n#.#\n");
  EXPECT_EQ(east.nadir, (GridGeometry::CellPosition{2.5, 1.5}));
}

TEST(QuarterTurned, PutsTheCellsOfEverySizeWhereAClockwiseTurnTakesThem) {
  std::mt19937_64 random(4);
  for (const auto& [cols, rows] : std::vector<std::pair<int, int>>{{1, 1}, {8, 8}, {7, 20}, {40, 9}, {33, 47}}) {
    const CellArray cells = testing::random_cells(random, cols, rows, 0.1);
    const CellArray turned = quarter_turned(cells);
    ASSERT_EQ(turned.cols(), rows);
    ASSERT_EQ(turned.rows(), cols);
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < cols; ++col) ASSERT_EQ(turned.at(rows - 1 - row, col), cells.at(col, row));
    }
  }
}

TEST(CutOut, ReturnsTheGridItselfAtItsCentre) {
  const RoadGrid grid{{2.0, {10, 20}, 4, 4}, from_ascii("#..# .#.. ..#. ?..#")};
  const GridBox box = grid.geometry.box();
  EXPECT_EQ(cut_out(grid, {box.centre(), Angle::degrees(0)}, 4, 4, 2.0).cells, grid.cells);
}

TEST(CutOut, OfCellsNorthUpIsACopyWhereverItLies) {
  std::mt19937_64 random(9);
  const RoadGrid grid{{2.0, {-40, 70}, 30, 20}, testing::random_cells(random, 30, 20, 0.3)};
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  for (int round = 0; round < 200; ++round) {
    const int cols = 1 + below(50);
    const int rows = 1 + below(40);
    const int first_col = below(100) - 60;
    const int first_row = below(80) - 50;
    const auto centre_beside = [&](double cells) {
      return grid.geometry.point_at({first_col + cols / 2.0 + cells, first_row + rows / 2.0 + cells});
    };
    CellArray expected(cols, rows);
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < cols; ++col) expected.at(col, row) = grid.cells.get(first_col + col, first_row + row);
    }
    ASSERT_EQ(cut_out(grid, {centre_beside(0.0), Angle()}, cols, rows, 2.0).cells, expected) << round;
    ASSERT_EQ(cut_out(grid, {centre_beside(1e-9), Angle()}, cols, rows, 2.0).cells, expected) << "sampled, " << round;
  }
}

TEST(CutOut, UndoesARotation) {
  const FeatureMap map = FeatureMap::centred(from_ascii("##... "
                                                        ".#... "
                                                        ".#### "
                                                        "..#.. "
                                                        "?.#.. "),
                                             1.0);
  for (const double degrees : {0.0, 90.0, 180.0, 270.0}) {
    const FeatureMap turned = rotated(map, Angle::degrees(degrees));
    const RoadGrid grid{{1.0, {0, 0}, turned.cells.cols(), turned.cells.rows()}, turned.cells};
    const GridPose pose{grid.geometry.point_at(turned.nadir), Angle::degrees(degrees)};
    EXPECT_EQ(to_ascii(cut_out(grid, pose, 5, 5, 1.0).cells), to_ascii(map.cells)) << degrees;
  }
}

TEST(CutOut, BeyondTheGridNothingWasObserved) {
  const RoadGrid grid{{1.0, {0, 0}, 4, 4}, CellArray(4, 4, kNoRoad)};
  for (const double far : {100.0, -3e9, 1e300}) {
    EXPECT_EQ(cut_out(grid, {{far, far}, Angle()}, 3, 3, 1.0).cells.observed_count(), 0u) << far;
  }
}

TEST(Resampled, CoarserCellsAverageTheArea) {
  const FeatureMap map = FeatureMap::centred(from_ascii("##.. ##.. .... ...."), 1.0);
  const FeatureMap coarse = resampled(map, 2.0);
  EXPECT_EQ(coarse.cells.cols(), 2);
  EXPECT_EQ(coarse.nadir.col, 1.0);
  EXPECT_GT(coarse.cells.at(0, 0), coarse.cells.at(1, 0));
  EXPECT_GT(coarse.cells.at(0, 0), coarse.cells.at(1, 1));
}

TEST(Resampled, OfAMapFarSmallerThanACellNothingIsLeftAndAtOnce) {
  for (const double cell_m : {0.1, 1e-6, 1e-300}) {
    const FeatureMap coarse = resampled(FeatureMap::centred(CellArray(8, 5, kRoad), cell_m), 2.0);
    EXPECT_EQ(coarse.cells, CellArray(1, 1)) << cell_m;
  }
  EXPECT_EQ(resampled(FeatureMap::centred(CellArray(4000, 1, kRoad), 0.01), 2.0).cells.observed_count(), 0u);
}

}  // namespace
}  // namespace roadfix
