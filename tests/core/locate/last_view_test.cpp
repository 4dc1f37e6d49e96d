#include "core/locate/last_view.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <random>

#include "core/grid/resample.hpp"
#include "core/units/draws.hpp"
#include "tests/core/locate/track_fixture.hpp"
#include "tests/support/sketches.hpp"

namespace roadfix {
namespace {

using testing::Flight;
using testing::random_sketch;
using testing::Track;
using testing::with_parts_changed;

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

/// The same cells, but so many of a hundred are road instead of none or none instead of road.
FeatureMap noisy(FeatureMap features, int percent, std::mt19937_64& random) {
  for (Cell& cell : features.cells.cells()) {
    if (uniform(random, 0.0, 100.0) < percent) cell = cell == kRoad ? kNoRoad : kRoad;
  }
  return features;
}

SentPicture of_bytes(std::uint64_t digest) { return {digest, {}}; }

/// Other bytes of a picture at each call, with some noise.
SentPicture encoded_anew(const PictureSketch& sketch) {
  static std::uint64_t digest = 1'000'000;
  return {++digest, with_parts_changed(sketch, 0.03)};
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
  EXPECT_FALSE(is_same_view(street_at(3), larger));
  for (const int rows : {20, 10}) {
    EXPECT_EQ(view.take_in(FeatureMap::centred(CellArray(400 / rows, rows, kRoad), 2.0)), View::kNew) << rows;
    view.move(forward(20.0), true);
  }
}

TEST(LastView, OfTwoWoodsIsNotTheSame) {
  const FeatureMap wood = FeatureMap::centred(CellArray(20, 20, kNoRoad), 2.0);
  EXPECT_FALSE(is_same_view(wood, wood));
  EXPECT_TRUE(is_same_view(street_at(3), street_at(3)));
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

TEST_F(Track, FollowsItsOdometryWhereTheCameraHasStopped) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  ASSERT_TRUE(fly(tracker, flight, 10).converged());
  const StepInput last = flight.step();
  advance(tracker, last);
  for (int i = 0; i < 15; ++i) {
    StepInput step = flight.step();
    step.features = last.features;
    const TrackEstimate estimate = advance(tracker, step);
    EXPECT_EQ(estimate.measurement, Measurement::kRepeated) << "step " << i;
    EXPECT_FALSE(estimate.converged()) << "step " << i;
    EXPECT_LT(error_m(estimate, flight.pose()), 25.0) << "step " << i;
    EXPECT_FALSE(estimate.odometry_is_wrong) << "step " << i;
  }
  const TrackEstimate seeing = fly(tracker, flight, 1);
  EXPECT_NE(seeing.measurement, Measurement::kRepeated);
}

/// Whose camera has stopped, and whose attitude is told anew with each picture.
class TrackOfAStoppedCamera : public Track {
 protected:
  /// Flies until it claims a place, and 15 steps on after the camera has stopped. `picture`: what is sent from then on.
  void fly_on(const std::function<SentPicture()>& picture, const Look& look) {
    ASSERT_TRUE(fly(tracker_, flight_, 10).converged());
    StepInput last = flight_.step();
    last.picture = picture();
    advance(tracker_, last);
    std::mt19937_64 random(7);
    const GridPose stopped = flight_.pose();
    for (int i = 0; i < 15; ++i) {
      StepInput step = flight_.step(false);
      const BodyOffset leant{uniform(random, -9.0, 9.0), uniform(random, -9.0, 9.0), {}};
      step.features = testing::observed_at(map_, moved(stopped, leant), 128, 128, 2.0, flight_.noise, random);
      step.picture = picture();
      const TrackEstimate estimate = advance(tracker_, step);
      look(i, estimate);
      EXPECT_LT(error_m(estimate, flight_.pose()), 25.0) << "step " << i;
      EXPECT_FALSE(estimate.odometry_is_wrong) << "step " << i;
    }
  }

  const Tracker tracker_{view_, settings()};
  Flight flight_{map_, start_, 4};
};

TEST_F(TrackOfAStoppedCamera, FollowsItsOdometry) {
  fly_on([] { return of_bytes(17); },
         [](int i, const TrackEstimate& estimate) {
           EXPECT_EQ(estimate.measurement, Measurement::kRepeated) << "step " << i;
           EXPECT_FALSE(estimate.converged()) << "step " << i;
         });
}

TEST_F(TrackOfAStoppedCamera, FollowsItsOdometryThoughPicturesAreEncodedAnewToo) {
  fly_on([] { return encoded_anew(random_sketch(1)); },
         [](int i, const TrackEstimate& estimate) {
           EXPECT_EQ(estimate.measurement, i == 0 ? Measurement::kUseless : Measurement::kRepeated) << "step " << i;
           EXPECT_EQ(estimate.converged(), i == 0) << "step " << i;
         });
  EXPECT_FALSE(fly(tracker_, flight_, 1).converged()) << "it may not be where its odometry told";
  EXPECT_TRUE(fly(tracker_, flight_, 5).converged());
}

TEST_F(Track, ClaimsNoPlaceThatAMovementCountedTwiceHasLedTo) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  ASSERT_TRUE(fly(tracker, flight, 10).converged());
  for (int i = 0; i < 20; ++i) {
    StepInput step = flight.step();
    step.sequence = 10 + 2 * i;
    const auto claims_rightly = [&](const TrackEstimate& estimate) {
      return !estimate.converged() || error_m(estimate, flight.pose()) < 15.0;
    };
    EXPECT_TRUE(claims_rightly(advance(tracker, step))) << "step " << i;
    ++step.sequence;
    step.time_us += 300'000;
    EXPECT_FALSE(advance(tracker, step).converged()) << "step " << i;
  }
}

TEST_F(Track, ClaimsNothingWhereTheCameraHasStoppedThoughItsPicturesChangeByNoise) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  ASSERT_TRUE(fly(tracker, flight, 10).converged());
  const StepInput last = flight.step();
  advance(tracker, last);
  std::mt19937_64 random(7);
  for (int i = 0; i < 15; ++i) {
    StepInput step = flight.step();
    step.features = noisy(*last.features, 3, random);
    const TrackEstimate estimate = advance(tracker, step);
    EXPECT_EQ(estimate.measurement, Measurement::kRepeated) << "step " << i;
    EXPECT_FALSE(estimate.converged()) << "step " << i;
    EXPECT_LT(error_m(estimate, flight.pose()), 25.0) << "step " << i;
  }
  EXPECT_TRUE(fly(tracker, flight, 5).converged());
}

TEST_F(Track, IsHeldBackByAStoppedCameraForSomeCellsOnly) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  ASSERT_TRUE(fly(tracker, flight, 10).converged());
  flight.step_m = 3.0;
  const StepInput last = flight.step();
  advance(tracker, last);
  std::mt19937_64 random(7);
  for (int i = 1; i <= 20; ++i) {
    StepInput step = flight.step();
    step.features = noisy(*last.features, 3, random);
    const TrackEstimate estimate = advance(tracker, step);
    EXPECT_LT(error_m(estimate, flight.pose()), 25.0) << "step " << i;
    // Three cells of 4 m since the view that the stopped one is compared with, and as many since the one before that.
    EXPECT_TRUE(3.0 * i < 24.0 || !estimate.converged()) << "step " << i;
  }
}

}  // namespace
}  // namespace roadfix
