#include "core/locate/last_view.hpp"

#include <gtest/gtest.h>

#include "tests/core/locate/track_fixture.hpp"

namespace roadfix {
namespace {

using testing::Flight;
using testing::Track;

FeatureMap street_at(int col) {
  CellArray cells(20, 20, kNoRoad);
  for (int row = 0; row < 20; ++row) cells.at(col, row) = kRoad;
  return FeatureMap::centred(cells, 2.0);
}

Odometry forward(double m) { return {m, 0.0, {}}; }

TEST(LastView, IsSeenAgainOnceTheVehicleHasMoved) {
  LastView view;
  EXPECT_FALSE(view.sees_again(street_at(3)));
  view.move(forward(0.6));
  EXPECT_FALSE(view.sees_again(street_at(3))) << "it may hover";
  view.move(forward(-0.6));
  EXPECT_TRUE(view.sees_again(street_at(3)));
  view.move(forward(0.0));
  EXPECT_TRUE(view.sees_again(street_at(3)));
  EXPECT_FALSE(view.sees_again(street_at(4)));
  view.move(Odometry{0.0, 0.0, Angle::degrees(-1.0)});
  EXPECT_TRUE(view.sees_again(street_at(4)));
}

TEST(LastView, IsSeenAgainWhereNoOdometryTellsThatTheVehicleHovers) {
  LastView view;
  EXPECT_FALSE(view.sees_again(street_at(3)));
  view.move(std::nullopt);
  EXPECT_TRUE(view.sees_again(street_at(3)));
}

TEST(LastView, OfGroundWithoutRoadsTellsNothing) {
  LastView view;
  const FeatureMap wood = FeatureMap::centred(CellArray(20, 20, kNoRoad), 2.0);
  EXPECT_FALSE(view.sees_again(wood));
  view.move(forward(20.0));
  EXPECT_FALSE(view.sees_again(wood));
}

TEST(LastView, IsAnotherInCellsOfAnotherSize) {
  LastView view;
  FeatureMap larger = street_at(3);
  larger.cell_m = 3.0;
  EXPECT_FALSE(view.sees_again(street_at(3)));
  view.move(forward(20.0));
  EXPECT_FALSE(view.sees_again(larger));
}

TEST_F(Track, FollowsItsOdometryWhereTheCameraHasStopped) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  ASSERT_TRUE(fly(tracker, flight, 10).converged);
  const StepInput last = flight.step();
  advance(tracker, last);
  for (int i = 0; i < 15; ++i) {
    StepInput step = flight.step();
    step.features = last.features;
    const TrackEstimate estimate = advance(tracker, step);
    EXPECT_EQ(estimate.measurement, Measurement::kRepeated) << "step " << i;
    EXPECT_LT(error_m(estimate, flight.pose()), 25.0) << "step " << i;
    EXPECT_FALSE(estimate.drifts) << "step " << i;
  }
  const TrackEstimate seeing = fly(tracker, flight, 1);
  EXPECT_NE(seeing.measurement, Measurement::kRepeated);
}

}  // namespace
}  // namespace roadfix
