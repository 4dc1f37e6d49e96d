#include "core/grid/terrain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace roadfix {
namespace {

/// Three by two cells of 32 m whose north-western corner is (3200 E, 6400 N), rising by 10 m a cell to the east and by
/// 100 m to the south.
Terrain slope() {
  Terrain terrain = Terrain::unknown({32.0, {100, -200}, 3, 2});
  for (int row = 0; row < 2; ++row) {
    for (int col = 0; col < 3; ++col) {
      terrain.codes[static_cast<std::size_t>(3 * row + col)] = Terrain::code_of(500.0 + 10.0 * col + 100.0 * row);
    }
  }
  return terrain;
}

TEST(Terrain, KeepsHeightsToATenthOfAMetre) {
  Terrain terrain = Terrain::unknown({32.0, {0, 0}, 1, 1});
  for (const double height_m : {-430.5, 0.0, 123.45, 8848.86}) {
    terrain.codes[0] = Terrain::code_of(height_m);
    EXPECT_NEAR(terrain.cell_height_m(0, 0).value(), height_m, 0.1 + 1e-9);
  }
}

TEST(Terrain, TakesTheNearestHeightThatItCanKeepAndNaNForUnknown) {
  Terrain terrain = Terrain::unknown({32.0, {0, 0}, 1, 1});
  EXPECT_FALSE(terrain.cell_height_m(0, 0));
  terrain.codes[0] = Terrain::code_of(-11'000.0);
  EXPECT_EQ(terrain.cell_height_m(0, 0), Terrain::kHeights.lowest_m);
  terrain.codes[0] = Terrain::code_of(1e9);
  EXPECT_NEAR(terrain.cell_height_m(0, 0).value(), Terrain::kHeights.highest_m, 1e-9);
  EXPECT_EQ(Terrain::code_of(std::numeric_limits<double>::quiet_NaN()), Terrain::kUnknown);
}

TEST(Terrain, IsBilinearBetweenTheCentresOfCells) {
  const Terrain terrain = slope();
  EXPECT_NEAR(terrain.height_m({3216.0, 6384.0}).value(), 500.0, 1e-9) << "a centre";
  EXPECT_NEAR(terrain.height_m({3224.0, 6384.0}).value(), 502.5, 1e-9) << "a quarter of a cell to the east";
  EXPECT_NEAR(terrain.height_m({3224.0, 6368.0}).value(), 552.5, 1e-9) << "and half a cell to the south";
}

TEST(Terrain, GoesOnAsFarAsItsCellsReachAndNoFarther) {
  const Terrain terrain = slope();
  EXPECT_NEAR(terrain.height_m({3201.0, 6399.0}).value(), 500.0, 1e-9);
  EXPECT_FALSE(terrain.height_m({3100.0, 6399.0}));
  EXPECT_FALSE(terrain.height_m({1e12, -1e12}));
}

TEST(Terrain, LeavesOutCellsThatAreUnknown) {
  Terrain terrain = slope();
  terrain.codes[1] = Terrain::kUnknown;
  EXPECT_NEAR(terrain.height_m({3224.0, 6384.0}).value(), 500.0, 1e-9) << "of the two around the point one is left";
  EXPECT_FALSE(terrain.height_m({3248.0, 6384.0})) << "its centre";
}

TEST(Terrain, TellsTheHeightsOfABoxWithTheCellsNextToIt) {
  const Terrain terrain = slope();
  EXPECT_EQ(terrain.heights_within({{3205.0, 6395.0}, {3206.0, 6396.0}}), (HeightRange{500.0, 610.0}));
  EXPECT_EQ(terrain.heights_within(terrain.geometry.box()), (HeightRange{500.0, 620.0}));
  EXPECT_FALSE(terrain.heights_within({{0.0, 0.0}, {100.0, 100.0}}));
  EXPECT_FALSE(Terrain::unknown(terrain.geometry).heights_within(terrain.geometry.box()));
}

}  // namespace
}  // namespace roadfix
