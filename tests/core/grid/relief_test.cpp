#include "core/grid/relief.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadfix {
namespace {

constexpr GridPoint kHere{600'000.0, 4'000'000.0};
constexpr double kAglM = 300.0;

/// A kilometre around here, at a height of 500 m in the middle that rises by `slope` to the east.
Terrain rising_to_the_east(double slope) {
  const GridBox box = grown({kHere, kHere}, 512.0);
  Terrain terrain = Terrain::unknown(GridGeometry::covering(box, Terrain::kFinestCellM));
  const GridGeometry& geometry = terrain.geometry;
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      const double east_m = geometry.cell_center(col, row).east_m - kHere.east_m;
      terrain.codes[static_cast<std::size_t>(row * geometry.cols + col)] = Terrain::code_of(500.0 + slope * east_m);
    }
  }
  return terrain;
}

/// A street every 40 m in both directions, in cells of 2 m.
FeatureMap streets(int side) {
  CellArray cells(side, side, kNoRoad);
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      if (col % 20 < 4 || row % 20 < 4) cells.at(col, row) = kRoad;
    }
  }
  return FeatureMap::centred(std::move(cells), 2.0);
}

/// Mean difference of the cells of the middle, `side` cells across.
double difference(const FeatureMap& a, const FeatureMap& b, int side) {
  double sum = 0.0;
  for (int row = -side / 2; row < side / 2; ++row) {
    for (int col = -side / 2; col < side / 2; ++col) {
      const auto at = [&](const FeatureMap& map) {
        return map.cells.get(static_cast<int>(map.nadir.col) + col, static_cast<int>(map.nadir.row) + row);
      };
      sum += std::abs(int{at(a)} - int{at(b)});
    }
  }
  return sum / (side * side);
}

TEST(Relief, ShowsHigherGroundFartherFromTheNadirAndLowerGroundNearer) {
  const Terrain terrain = rising_to_the_east(0.1);
  const Relief relief(terrain, {kHere, {}}, kAglM);
  constexpr double kTolerance = 1e-3;  // heights are kept in steps of 0.2 m
  EXPECT_NEAR(relief.stretch_of(120.0, 0.0), 300.0 / 288.0, kTolerance);
  EXPECT_NEAR(relief.stretch_of(-120.0, 0.0), 300.0 / 312.0, kTolerance);
  EXPECT_NEAR(relief.stretch_of(0.0, 120.0), 1.0, kTolerance);
}

TEST(Relief, IsThatOfTheGroundInTheDirectionInWhichTheVehicleHeads) {
  const Terrain terrain = rising_to_the_east(0.1);
  constexpr double kTolerance = 1e-3;
  const Relief northwest(terrain, {kHere, Angle::degrees(-45.0)}, kAglM);
  EXPECT_NEAR(northwest.stretch_of(0.0, 120.0), 300.0 / (300.0 - 12.0 / std::sqrt(2.0)), kTolerance) << "behind it";
  const Relief east(terrain, {kHere, Angle::degrees(90.0)}, kAglM);
  EXPECT_NEAR(east.stretch_of(0.0, -120.0), 300.0 / 288.0, kTolerance) << "before it";
  EXPECT_NEAR(east.stretch_of(120.0, 0.0), 1.0, kTolerance) << "to its right";
}

TEST(Relief, KnowsWhichGroundIsShownWhere) {
  const Terrain terrain = rising_to_the_east(0.3);
  const Relief relief(terrain, {kHere, Angle::degrees(20.0)}, kAglM);
  for (const double right_m : {-150.0, -20.0, 60.0, 150.0}) {
    for (const double back_m : {-150.0, 0.0, 150.0}) {
      const double stretch = relief.stretch_at(right_m, back_m);
      EXPECT_NEAR(stretch, relief.stretch_of(right_m / stretch, back_m / stretch), 2e-3);
    }
  }
}

TEST(Relief, IsNoneWhereTheHeightOfTheGroundIsUnknown) {
  const Terrain unknown = Terrain::unknown(rising_to_the_east(0.1).geometry);
  EXPECT_EQ(Relief(unknown, {kHere, {}}, kAglM).stretch_of(120.0, 50.0), 1.0);
  const Terrain terrain = rising_to_the_east(0.1);
  EXPECT_EQ(Relief(terrain, {{0.0, 0.0}, {}}, kAglM).stretch_of(120.0, 50.0), 1.0);
}

TEST(Relief, TellsHowFarTheEdgesOfAFrameAreOff) {
  const Terrain terrain = rising_to_the_east(0.1);
  const FeatureMap frame = streets(150);
  EXPECT_NEAR(Relief(terrain, {kHere, {}}, kAglM).largest_shift_m(frame), std::hypot(150.0, 150.0) * 0.05, 0.7);
  EXPECT_NEAR(Relief(rising_to_the_east(0.0), {kHere, {}}, kAglM).largest_shift_m(frame), 0.0, 1e-9);
}

TEST(Levelled, UndoesWhatTheReliefOfTheGroundDoesToAFrame) {
  const Terrain terrain = rising_to_the_east(0.15);
  const Relief relief(terrain, {kHere, Angle::degrees(30.0)}, kAglM);
  const FeatureMap ground = streets(240);
  const FeatureMap shown = shown_in_relief(ground, relief, 160, 160);
  const FeatureMap level = levelled(shown, relief);
  EXPECT_EQ(level.cell_m, ground.cell_m);
  const double before = difference(shown, ground, 130);
  EXPECT_GT(before, 20.0);
  EXPECT_LT(difference(level, ground, 130), 0.3 * before) << "but for the rims of roads, which are interpolated twice";
}

TEST(Levelled, KeepsAllGroundThatTheFrameShows) {
  const Terrain terrain = rising_to_the_east(0.15);
  const FeatureMap frame = streets(160);
  const FeatureMap level = levelled(frame, Relief(terrain, {kHere, {}}, kAglM));
  EXPECT_GT(level.nadir.col, 80.0) << "the lower ground, west of the nadir, lies farther off than it is shown";
  EXPECT_LT(level.cells.cols() - level.nadir.col, 80.0);
  EXPECT_TRUE(is_observed(level.cells.get(1, static_cast<int>(level.nadir.row)))) << "the western edge";
}

TEST(Levelled, HasNoMoreCellsForANadirFarOffTheFrame) {
  const Terrain terrain = rising_to_the_east(0.05);
  FeatureMap frame = streets(50);
  frame.nadir = {25.0, 180.0};
  const FeatureMap level = levelled(frame, Relief(terrain, {kHere, {}}, kAglM));
  EXPECT_LT(level.cells.rows(), 60);
  EXPECT_NEAR(level.nadir.row, 180.0, 5.0);
  EXPECT_GT(level.cells.observed_count(), 0.9 * 50 * 50);
}

}  // namespace
}  // namespace roadfix
