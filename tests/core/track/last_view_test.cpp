#include "core/track/last_view.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "core/grid/resample.hpp"
#include "tests/core/track/stopped_camera.hpp"

namespace roadfix {
namespace {

using testing::encoded_anew;
using testing::noisy;
using testing::of_bytes;
using testing::random_sketch;

FeatureMap street_at(int col) {
  CellArray cells(20, 20, kNoRoad);
  for (int row = 0; row < 20; ++row) cells.at(col, row) = kRoad;
  return FeatureMap::centred(cells, 2.0);
}

/// A street across and one along, as a vehicle sees them that has flown so many cells on.
FeatureMap crossing_after(int rows) {
  FeatureMap features = FeatureMap::centred(CellArray(60, 60, kNoRoad), 2.0);
  for (int i = 0; i < 60; ++i) {
    for (const int wide : {0, 1}) {
      features.cells.at(i, 20 + rows + wide) = kRoad;
      features.cells.at(35 + wide, i) = kRoad;
    }
  }
  return features;
}

Odometry forward(double m) { return {m, 0.0, {}}; }

TEST(LastView, IsSeenAgainOnceTheVehicleHasMoved) {
  LastView view;
  EXPECT_EQ(view.take_in(street_at(3)), View::kNew);
  view.move(forward(0.6), true);
  EXPECT_EQ(view.take_in(street_at(3)), View::kNew) << "it may hover";
  view.move(forward(-0.6), true);
  EXPECT_EQ(view.take_in(street_at(3)), View::kRepeated);
  view.move(forward(0.0), true);
  EXPECT_EQ(view.take_in(street_at(3)), View::kRepeated);
  EXPECT_EQ(view.take_in(street_at(4)), View::kNew);
  view.move(Odometry{0.0, 0.0, Angle::degrees(-0.5)}, true);
  EXPECT_EQ(view.take_in(street_at(4)), View::kNew) << "it may hover";
  view.move(Odometry{0.0, 0.0, Angle::degrees(-0.5)}, true);
  EXPECT_EQ(view.take_in(street_at(4)), View::kRepeated);
}

TEST(LastView, IsSeenAgainWhereALinkGoesRoundInItsLastPictures) {
  LastView view;
  for (int i = 0; i < 60; ++i) {
    const int col = i < 4 ? 16 : i % 3;
    EXPECT_EQ(view.take_in(street_at(col)), i == 0 || (i >= 4 && i < 7) ? View::kNew : View::kRepeated) << i;
    view.move(forward(1.0), false);
  }
  EXPECT_EQ(view.take_in(street_at(17)), View::kNew);
}

TEST(LastView, RemembersTheLastPicturesOnly) {
  LastView view;
  for (int col = 0; col < 20; ++col) {
    EXPECT_EQ(view.take_in(street_at(col), of_bytes(1000U + static_cast<unsigned>(col))), View::kNew);
    view.move(forward(1.0), false);
  }
  EXPECT_EQ(view.take_in(street_at(4)), View::kRepeated);
  EXPECT_EQ(view.take_in(street_at(3)), View::kNew);
}

TEST(LastView, IsSeenAgainWhereThePictureOfAWoodIs) {
  LastView view;
  const FeatureMap wood = FeatureMap::centred(CellArray(20, 20, kNoRoad), 2.0);
  EXPECT_EQ(view.take_in(wood, of_bytes(7)), View::kNew);
  view.move(forward(20.0), true);
  EXPECT_EQ(view.take_in(wood, of_bytes(7)), View::kRepeated);
  EXPECT_EQ(view.take_in(wood, of_bytes(8)), View::kNew);
}

TEST(LastView, IsSeenAgainWhereThePictureIsTheSameThoughItWasMeasuredAnew) {
  LastView view;
  EXPECT_EQ(view.take_in(street_at(3), of_bytes(7)), View::kNew);
  view.move(forward(0.6), true);
  EXPECT_EQ(view.take_in(street_at(4), of_bytes(7)), View::kNew) << "it may hover";
  view.move(forward(0.6), true);
  EXPECT_EQ(view.take_in(street_at(5), of_bytes(7)), View::kRepeated);
  EXPECT_EQ(view.take_in(street_at(6), of_bytes(8)), View::kNew);
}

TEST(LastView, IsSeenAgainWhereNoOdometryTellsThatTheVehicleHovers) {
  LastView view;
  EXPECT_EQ(view.take_in(street_at(3)), View::kNew);
  view.move(std::nullopt, true);
  EXPECT_EQ(view.take_in(street_at(3)), View::kRepeated);
}

TEST(LastView, OfGroundWithoutRoadsTellsNothing) {
  LastView view;
  const FeatureMap wood = FeatureMap::centred(CellArray(20, 20, kNoRoad), 2.0);
  EXPECT_EQ(view.take_in(wood), View::kNew);
  view.move(forward(20.0), true);
  EXPECT_EQ(view.take_in(wood), View::kNew);
}

TEST(LastView, IsAnotherInCellsOfAnotherSize) {
  LastView view;
  FeatureMap larger = street_at(3);
  larger.cell_m = 3.0;
  EXPECT_EQ(view.take_in(street_at(3)), View::kNew);
  view.move(forward(20.0), true);
  EXPECT_EQ(view.take_in(larger), View::kNew);
  for (const int rows : {20, 10}) {
    EXPECT_EQ(view.take_in(FeatureMap::centred(CellArray(400 / rows, rows, kRoad), 2.0)), View::kNew) << rows;
    view.move(forward(20.0), true);
  }
}

TEST(LastView, StandsStillWhereItsRoadsDoNotMoveAsTheOdometryTells) {
  std::mt19937_64 random(3);
  LastView view;
  EXPECT_EQ(view.take_in(crossing_after(0)), View::kNew);
  view.move(forward(8.0), true);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kNew) << "not far enough to tell";
  view.move(forward(12.0), true);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kStandsStill);
  view.move(forward(1000.0), true);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kStandsStill);
  EXPECT_EQ(view.take_in(crossing_after(10)), View::kNew);
}

TEST(LastView, IsComparedWhereAQuarterOfItShouldBeSeenAgain) {
  const auto still_after = [](double forward_m) {
    std::mt19937_64 random(3);
    LastView view;
    EXPECT_EQ(view.take_in(crossing_after(0)), View::kNew);
    view.move(Odometry{forward_m, 10.0, {}}, true);
    return view.take_in(noisy(crossing_after(0), 3, random));
  };
  EXPECT_EQ(still_after(80.0), View::kStandsStill) << "of 120 m";
  EXPECT_EQ(still_after(100.0), View::kNew);
}

TEST(LastView, IsNewOnceGroundWithoutRoadsWasSeen) {
  std::mt19937_64 random(3);
  const FeatureMap wood = FeatureMap::centred(CellArray(60, 60, kNoRoad), 2.0);
  LastView view;
  EXPECT_EQ(view.take_in(crossing_after(0)), View::kNew);
  view.move(forward(20.0), true);
  EXPECT_EQ(view.take_in(wood), View::kNew);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kNew);
  view.move(forward(20.0), true);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kStandsStill);
  EXPECT_EQ(view.take_in(wood), View::kNew);
  EXPECT_FALSE(view.stands_still);
}

TEST(LastView, StandsStillWhereItsPictureDoesThoughItIsEncodedAndMeasuredAnew) {
  const PictureSketch sketch = random_sketch(1);
  LastView view;
  EXPECT_EQ(view.take_in(crossing_after(0), encoded_anew(sketch)), View::kNew);
  view.move(forward(5.0), true);
  EXPECT_EQ(view.take_in(crossing_after(7), encoded_anew(sketch)), View::kNew) << "not far enough to tell: 120 m seen";
  view.move(forward(5.0), false);
  EXPECT_EQ(view.take_in(crossing_after(3), encoded_anew(sketch)), View::kMayStandStill) << "whatever the wind";
  EXPECT_EQ(view.take_in(crossing_after(5), encoded_anew(sketch)), View::kStandsStill);
  view.move(forward(-10.0), true);
  EXPECT_EQ(view.take_in(crossing_after(9), encoded_anew(sketch)), View::kStandsStill);
  EXPECT_EQ(view.take_in(crossing_after(9), encoded_anew(random_sketch(2))), View::kNew);
}

TEST(LastView, StandsStillWhereItsPictureDoesNotTurnWithTheVehicle) {
  const PictureSketch sketch = random_sketch(1);
  const FeatureMap wood = FeatureMap::centred(CellArray(20, 20, kNoRoad), 2.0);
  LastView view;
  EXPECT_EQ(view.take_in(wood, encoded_anew(sketch)), View::kNew);
  view.move(Odometry{0.0, 0.0, Angle::degrees(9.0)}, true);
  EXPECT_EQ(view.take_in(wood, encoded_anew(sketch)), View::kNew);
  view.move(Odometry{0.0, 0.0, Angle::degrees(2.0)}, true);
  EXPECT_EQ(view.take_in(wood, encoded_anew(sketch)), View::kMayStandStill);
  EXPECT_EQ(view.take_in(wood, encoded_anew(sketch)), View::kStandsStill);
}

TEST(LastView, OfAVehicleThatLeansByAsMuchAsItMovesStandsStillOnlyIfItDoesSoTwice) {
  LastView view;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const PictureSketch sketch = random_sketch(seed);
    EXPECT_EQ(view.take_in(crossing_after(5 * static_cast<int>(seed)), encoded_anew(sketch)), View::kNew);
    view.move(forward(20.0), false);
    EXPECT_EQ(view.take_in(crossing_after(0), encoded_anew(sketch)), View::kMayStandStill);
    view.move(forward(20.0), true);
  }
}

TEST(LastView, OfAVehicleThatStaysInPlaceMayStandStill) {
  std::mt19937_64 random(3);
  const PictureSketch sketch = random_sketch(1);
  LastView view;
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(view.take_in(noisy(crossing_after(i % 2), 3, random), encoded_anew(sketch)), View::kNew) << i;
    view.move(forward(i % 2 == 0 ? 2.0 : -2.0), true);
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(view.take_in(crossing_after(10 + i), encoded_anew(sketch)), View::kNew) << "nobody says that it moves";
    view.move(std::nullopt, true);
  }
  view.move(forward(20.0), true);
  view.move(std::nullopt, true);
  EXPECT_EQ(view.take_in(crossing_after(16), encoded_anew(sketch)), View::kNew) << "it may have come back";
}

TEST(LastView, StandsStillThoughItsHeightIsToldALittleOtherwise) {
  std::mt19937_64 random(3);
  LastView view;
  EXPECT_EQ(view.take_in(crossing_after(0)), View::kNew);
  view.move(forward(20.0), true);
  const FeatureMap higher = resampled(noisy(crossing_after(0), 3, random), 2.0, 1.03);
  ASSERT_NE(higher.cells.cols(), 60);
  EXPECT_EQ(view.take_in(higher), View::kStandsStill);
}

TEST(LastView, IsNewWhereItsRoadsMoveAsTheOdometryTells) {
  std::mt19937_64 random(3);
  LastView view;
  for (const int rows : {0, 8, 16, 24}) {
    EXPECT_EQ(view.take_in(noisy(crossing_after(rows), 3, random)), View::kNew) << rows;
    view.move(forward(16.0), true);
  }
}

TEST(LastView, OfOneRoadAlongTheWayTellsNothing) {
  std::mt19937_64 random(3);
  LastView view;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(view.take_in(noisy(street_at(9), 3, random)), View::kNew);
    view.move(forward(16.0), true);
  }
}

TEST(LastView, OfARoadAlongTheWayWithAStubBesideItTellsNothing) {
  FeatureMap stub = FeatureMap::centred(CellArray(60, 60, kNoRoad), 2.0);
  for (int row = 0; row < 60; ++row) stub.cells.at(35, row) = stub.cells.at(36, row) = kRoad;
  for (int col = 37; col < 46; ++col) stub.cells.at(col, 20) = stub.cells.at(col, 21) = kRoad;
  std::mt19937_64 random(3);
  LastView view;
  EXPECT_EQ(view.take_in(stub), View::kNew);
  view.move(forward(20.0), true);
  EXPECT_EQ(view.take_in(noisy(stub, 1, random)), View::kNew);
}

TEST(LastView, IsNotComparedWhereTheOdometryDoesNotTellTheMotionOverTheGround) {
  std::mt19937_64 random(3);
  LastView view;
  EXPECT_EQ(view.take_in(crossing_after(0)), View::kNew);
  view.move(forward(20.0), false);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kNew);
  view.move(std::nullopt, true);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kNew);
  view.move(forward(20.0), true);
  view.move(forward(0.0), false);
  EXPECT_EQ(view.take_in(noisy(crossing_after(0), 3, random)), View::kNew) << "the wind may have taken it back";
}

}  // namespace
}  // namespace roadfix
