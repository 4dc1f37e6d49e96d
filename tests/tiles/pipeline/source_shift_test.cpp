#include "tiles/pipeline/source_shift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/grid/cell_array.hpp"
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
  const auto shift = shift_of(shared_evidence(12, -8), kCellM);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->east_m, -24.0);
  EXPECT_EQ(shift->north_m, -16.0);
  EXPECT_GT(shift->correlation, 0.99);
  EXPECT_LT(shift->correlation_in_place, 0.5);
}

TEST(SourceShift, IsNoneWhereTheyAgreeOrHaveNothingInCommon) {
  EXPECT_FALSE(shift_of(shared_evidence(0, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(1, -1), kCellM)) << "no more than a step";
  EXPECT_FALSE(shift_of(shared_evidence(0, 0, 6), kCellM)) << "another town";
  EXPECT_FALSE(shift_of({}, kCellM));
}

TEST(SourceShift, IsNoneThatMayGoOnBeyondTheShiftsThatWereTried) {
  EXPECT_TRUE(shift_of(shared_evidence(48, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(50, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(51, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(0, -51), kCellM));
}

/// So many of the nine tiles lie in place, the others too far east.
SharedEvidence in_place_but(int in_place, int east) {
  SharedEvidence result = shared_evidence(east, 0);
  const SharedEvidence same = shared_evidence(0, 0);
  std::copy_n(same.tiles.begin(), in_place, result.tiles.begin());
  return result;
}

TEST(SourceShift, IsNoneThatFitsHardlyBetterThanTheSourceInItsPlace) {
  EXPECT_TRUE(shift_of(in_place_but(1, 4), kCellM));
  EXPECT_FALSE(shift_of(in_place_but(3, 4), kCellM));
}

TEST(SourceShift, StandsForARegistrationErrorWhoseEllipseOf95PercentHoldsTheOtherSide) {
  for (const int east : {6, 9, 20}) {
    const auto shift = shift_of(shared_evidence(east, 0), kCellM);
    ASSERT_TRUE(shift) << east;
    const double length_m = std::hypot(shift->east_m, shift->north_m);
    constexpr double kSigmasOf95 = 2.45;
    EXPECT_GT(kSigmasOf95 * shift->sigma_m, length_m);
    EXPECT_LT(2.0 * shift->sigma_m, length_m + 1e-9) << "and not much more";
  }
}

TEST(SourceShift, IsNoneThatTheRegistrationErrorsExplain) {
  SharedEvidence both = shared_evidence(12, 0);
  both.others_sigma_m = 8.0;
  both.own_sigma_m = 8.0;
  EXPECT_TRUE(shift_of(both, kCellM)) << "24 m, 2 sigma are 23 m";
  both.own_sigma_m = 9.0;
  EXPECT_FALSE(shift_of(both, kCellM));
}

TEST(SourceShift, HoldsWhereHalfOfTheGroundWasNotObserved) {
  SharedEvidence half = shared_evidence(12, 0);
  for (SharedEvidence::Tile& tile : half.tiles) {
    for (int row = 0; row < kTileCells; ++row) {
      for (int col = 0; col < kTileCells / 2; ++col) tile.own.at(col, row) = kUnobserved;
    }
  }
  const auto shift = shift_of(half, kCellM);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->east_m, -24.0);
  EXPECT_EQ(shift->north_m, 0.0);
  EXPECT_GT(shift->correlation, 0.99) << "of what both observed";
}

TEST(SourceShift, HasACorrelationOfOneAtMostWhereSquaresWereObservedInPart) {
  SharedEvidence striped = shared_evidence(12, -8);
  for (SharedEvidence::Tile& tile : striped.tiles) {
    for (int row = 0; row < kTileCells; row += 2) std::ranges::fill(tile.own.row(row), kUnobserved);
  }
  const auto shift = shift_of(striped, kCellM);
  ASSERT_TRUE(shift);
  EXPECT_GT(shift->correlation, 0.9);
  EXPECT_LE(shift->correlation, 1.0);
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
  for (int cols = 4; cols <= 124; cols += 12) EXPECT_FALSE(shift_of(overlapping(cols, 0, 0), kCellM)) << cols;
}

TEST(SourceShift, IsNoneWhereTooLittleGroundIsSharedToTell) {
  EXPECT_FALSE(shift_of(overlapping(16, 12, -8), kCellM));
  EXPECT_FALSE(shift_of(overlapping(70, 12, -8), kCellM)) << "0.22 km^2";
  EXPECT_TRUE(shift_of(overlapping(100, 12, -8), kCellM));
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
  EXPECT_FALSE(shift_of(one_road(12), kCellM)) << "how far along the road, nobody knows";
}

TEST(SourceShift, IsNoneOfRegularStreetsThatFitABlockAwayAsWell) {
  const CellArray blocks = testing::grid_city({kCellM, {0, 0}, 600, 600}, 60.0).cells;
  SharedEvidence city;
  city.tiles.push_back({CellArray(kTileCells, kTileCells), CellArray(kTileCells, kTileCells)});
  paste(blocks, city.tiles[0].own, -90, -100);
  paste(blocks, city.tiles[0].others, -100, -100);
  EXPECT_FALSE(shift_of(city, kCellM));
}

TEST(SourceShift, IsHardlyEverOneOfFewRoadsThatHaveNothingInCommon) {
  int shifts = 0;
  for (std::uint64_t seed = 100; seed < 108; ++seed) {
    for (SharedEvidence::Tile& tile : shared_evidence(0, 0, seed).tiles) {
      SharedEvidence one;
      one.tiles.push_back(std::move(tile));
      if (shift_of(one, kCellM)) ++shifts;
    }
  }
  EXPECT_LE(shifts, 1) << "of 72 overlaps of 0.26 km^2";
}

}  // namespace
}  // namespace roadfix
