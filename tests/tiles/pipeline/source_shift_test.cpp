#include "tiles/pipeline/source_shift.hpp"

#include <gtest/gtest.h>

#include "core/grid/resample.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

constexpr double kCellM = 2.0;

/// Nine tiles of a town, and what a source says of them whose georeference lies so many cells too far east and south.
SharedEvidence shared_evidence(int east, int south, std::uint64_t others_seed = 5) {
  constexpr int kTown = 3 * kTileCells + 200;
  const CellArray own = testing::street_map(5, {kCellM, {0, 0}, kTown, kTown}).cells;
  const CellArray others = testing::street_map(others_seed, {kCellM, {0, 0}, kTown, kTown}).cells;
  SharedEvidence result;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      const int west = 100 + kTileCells * col;
      const int north = 100 + kTileCells * row;
      SharedEvidence::Tile tile{CellArray(kTileCells, kTileCells), CellArray(kTileCells, kTileCells)};
      paste(own, tile.own, east - west, south - north);
      paste(others, tile.others, -west, -north);
      result.tiles.push_back(std::move(tile));
    }
  }
  return result;
}

TEST(SourceShift, IsWhereASourceFitsTheOthers) {
  const auto shift = shift_of(shared_evidence(12, -8), kCellM, 0.0);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->east_m, -24.0);
  EXPECT_EQ(shift->north_m, -16.0);
  EXPECT_GT(shift->correlation, 0.99);
  EXPECT_LT(shift->correlation_in_place, 0.5);
}

TEST(SourceShift, IsNoneWhereTheyAgreeOrHaveNothingInCommon) {
  EXPECT_FALSE(shift_of(shared_evidence(0, 0), kCellM, 0.0));
  EXPECT_FALSE(shift_of(shared_evidence(1, -1), kCellM, 0.0)) << "no more than a step";
  EXPECT_FALSE(shift_of(shared_evidence(0, 0, 6), kCellM, 0.0)) << "another town";
  EXPECT_FALSE(shift_of({}, kCellM, 0.0));
}

TEST(SourceShift, IsNoneThatTheRegistrationErrorsExplain) {
  SharedEvidence both = shared_evidence(12, 0);
  both.others_sigma_m = 8.0;
  EXPECT_TRUE(shift_of(both, kCellM, 8.0)) << "24 m, 2 sigma are 23 m";
  EXPECT_FALSE(shift_of(both, kCellM, 9.0));
}

TEST(SourceShift, HoldsWhereHalfOfTheGroundWasNotObserved) {
  SharedEvidence half = shared_evidence(12, 0);
  for (SharedEvidence::Tile& tile : half.tiles) {
    for (int row = 0; row < kTileCells; ++row) {
      for (int col = 0; col < kTileCells / 2; ++col) tile.own.at(col, row) = kUnobserved;
    }
  }
  const auto shift = shift_of(half, kCellM, 0.0);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->east_m, -24.0);
  EXPECT_EQ(shift->north_m, 0.0);
}

/// The source observed the west of the town, the others the east, and both a strip of so many columns.
SharedEvidence overlapping(int cols, int east, int south) {
  constexpr int kWest = 300;  // columns of the source
  SharedEvidence result = shared_evidence(east, south);
  for (std::size_t i = 0; i < result.tiles.size(); ++i) {
    const int first = static_cast<int>(i % 3) * kTileCells;
    for (int row = 0; row < kTileCells; ++row) {
      for (int col = 0; col < kTileCells; ++col) {
        if (first + col >= kWest) result.tiles[i].own.at(col, row) = kUnobserved;
        if (first + col < kWest - cols) result.tiles[i].others.at(col, row) = kUnobserved;
      }
    }
  }
  return result;
}

TEST(SourceShift, IsNoneOfANarrowOverlapThatFitsInPlace) {
  for (int cols = 4; cols <= 124; cols += 12) EXPECT_FALSE(shift_of(overlapping(cols, 0, 0), kCellM, 0.0)) << cols;
}

TEST(SourceShift, IsNoneWhereTooLittleGroundIsSharedToTell) {
  EXPECT_FALSE(shift_of(overlapping(16, 12, -8), kCellM, 0.0));
  EXPECT_TRUE(shift_of(overlapping(100, 12, -8), kCellM, 0.0));
}

/// One road from the west to the east, on every tile; that of the source lies so many cells to the north.
SharedEvidence one_road(int north) {
  SharedEvidence result;
  for (int i = 0; i < 9; ++i) {
    SharedEvidence::Tile tile{CellArray(kTileCells, kTileCells, kNoRoad), CellArray(kTileCells, kTileCells, kNoRoad)};
    for (int col = 0; col < kTileCells; ++col) {
      for (int row = 100; row < 104; ++row) {
        tile.own.at(col, row - north) = kRoad;
        tile.others.at(col, row) = kRoad;
      }
    }
    result.tiles.push_back(std::move(tile));
  }
  return result;
}

TEST(SourceShift, IsNoneThatASingleRoadTells) {
  EXPECT_FALSE(shift_of(one_road(12), kCellM, 0.0)) << "how far along the road, nobody knows";
}

TEST(SourceShift, IsNoneOfRegularStreetsThatFitABlockAwayAsWell) {
  const CellArray blocks = testing::grid_city({kCellM, {0, 0}, 600, 600}, 60.0).cells;
  SharedEvidence city;
  city.tiles.push_back({CellArray(kTileCells, kTileCells), CellArray(kTileCells, kTileCells)});
  paste(blocks, city.tiles[0].own, -90, -100);
  paste(blocks, city.tiles[0].others, -100, -100);
  EXPECT_FALSE(shift_of(city, kCellM, 0.0));
}

TEST(SourceShift, IsHardlyEverOneOfFewRoadsThatHaveNothingInCommon) {
  int shifts = 0;
  for (std::uint64_t seed = 100; seed < 108; ++seed) {
    for (SharedEvidence::Tile& tile : shared_evidence(0, 0, seed).tiles) {
      SharedEvidence one;
      one.tiles.push_back(std::move(tile));
      if (shift_of(one, kCellM, 0.0)) ++shifts;
    }
  }
  EXPECT_LE(shifts, 1) << "of 72 overlaps of 0.26 km^2";
}

}  // namespace
}  // namespace roadfix
