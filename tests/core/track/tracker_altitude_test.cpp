// Tracks of a vehicle that knows its height above the sea, over ground that is not level, or is wrong about its height.
#include <gtest/gtest.h>

#include <memory>

#include "core/grid/relief.hpp"
#include "tests/core/track/track_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/sloping_ground.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::Flight;
using testing::Track;

class TrackFromAltitude : public testing::Track {
 protected:
  TrackFromAltitude() { view_.terrain = std::make_shared<const Terrain>(ground_.terrain()); }

  /// As a client sends it who takes the vehicle to be `agl_m` above ground.
  StepInput taken_from(StepInput step, const GridPose& truth, double agl_m) const {
    step.altitude = Altitude{kAboveSeaM, agl_m};
    step.features = ground_.taken_for(*std::move(step.features), truth.position, *step.altitude);
    return step;
  }
  /// So many steps that send what they see in the size that the track asks for; each one that claims is right. Returns
  /// how many claim.
  int claims_of(const Tracker& tracker, int steps) {
    Flight flight(map_, start_, 3);
    int claims = 0;
    for (int i = 0; i < steps; ++i) {
      const StepInput step = flight.step();
      const double agl_m = tracker.agl_m(state_, kAboveSeaM);
      const TrackEstimate estimate = advance(tracker, taken_from(step, flight.pose(), agl_m));
      if (!estimate.converged()) continue;
      ++claims;
      EXPECT_LT(error_m(estimate, flight.pose()), 10.0) << "step " << i;
      EXPECT_NEAR(estimate.agl_m.value(), true_agl_m(flight.pose()), 1.5) << "step " << i;
    }
    return claims;
  }
  double true_agl_m(const GridPose& truth) const { return kAboveSeaM - ground_.height_m(truth.position); }

  static constexpr double kAboveSeaM = 420.0;
  testing::SlopingGround ground_{view_.extent, 200.0, 270.0};
};

TEST_F(TrackFromAltitude, FollowsTheHeightOfTheGroundBelow) {
  EXPECT_GE(claims_of(Tracker(view_, settings()), 40), 20);
}

TEST_F(TrackFromAltitude, FindsNothingInTheSizeOfAnotherHeight) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 3);
  for (int i = 0; i < 20; ++i) {
    StepInput step = taken_from(flight.step(), flight.pose(), 150.0);
    step.altitude.reset();
    EXPECT_FALSE(advance(tracker, step).converged()) << "step " << i;
  }
}

TEST_F(TrackFromAltitude, ClaimsPlacesOverGroundWhoseHeightsAllowTooManySizesToSearch) {
  ground_.east_m = 360.0;
  view_.terrain = std::make_shared<const Terrain>(ground_.terrain());
  ASSERT_GT(agl_above(view_, view_.extent, kAboveSeaM).value().scale_range(), kMaxScaleRange);
  TrackSettings near = settings();
  near.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 150.0};
  EXPECT_GE(claims_of(Tracker(view_, near), 30), 8);
}

TEST_F(TrackFromAltitude, LevelsWhatItSeesOfASlope) {
  constexpr double kAboveSlopeM = 680.0;
  ground_.east_m = 560.0;
  view_.terrain = std::make_shared<const Terrain>(ground_.terrain());
  TrackSettings near = settings();
  near.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 100.0};
  const Tracker tracker(view_, near);
  const auto mean_error_m = [&](bool tells_altitude) {
    state_ = {};
    Flight flight(map_, start_, 3);
    flight.side_cells = 180;
    double sum_m = 0.0;
    for (int i = 0; i < 20; ++i) {
      StepInput step = flight.step();
      const double agl_m = kAboveSlopeM - ground_.height_m(flight.pose().position);
      step.features = shown_in_relief(*step.features, Relief(*view_.terrain, flight.pose(), agl_m), 128, 128);
      if (tells_altitude) step.altitude = Altitude{kAboveSlopeM, agl_m};
      const TrackEstimate estimate = advance(tracker, step);
      if (i >= 10) sum_m += error_m(estimate, flight.pose());
    }
    return 0.1 * sum_m;
  };
  EXPECT_GT(mean_error_m(false), 2.0) << "in the right size, but displaced by up to 14 m";
  EXPECT_LT(mean_error_m(true), 1.0);
}

TEST_F(TrackFromAltitude, TellsTheHeightAboveTheGroundThatIsBelievedToBeBelow) {
  TrackSettings near = settings();
  near.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 50.0};
  const Tracker tracker(view_, near);
  EXPECT_NEAR(tracker.agl_m({}, kAboveSeaM), true_agl_m(start_), 3.0) << "before the first step";
  Flight flight(map_, start_, 3);
  StepInput step;
  step.time_us = 1;
  advance(tracker, step);
  EXPECT_NEAR(tracker.agl_m(state_, kAboveSeaM), true_agl_m(start_), 1.0) << "of the particles";
}

TEST_F(Track, LearnsAnErrorOfTheAltitudeThatItIsToldToExpect) {
  const auto end_of = [&](double range) {
    TrackSettings rough = settings();
    rough.vehicle.scale_range = range;
    const Tracker tracker(view_, rough);
    Flight flight(map_, start_, 3);
    state_ = {};
    TrackEstimate last;
    for (int i = 0; i < 20; ++i) {
      StepInput step = flight.step();
      step.features->cell_m /= 1.12;  // the ground is larger than the vehicle thinks
      last = advance(tracker, step);
      EXPECT_TRUE(!last.converged() || error_m(last, flight.pose()) < 20.0) << "step " << i;
    }
    return last;
  };
  const TrackEstimate told = end_of(0.2);
  EXPECT_TRUE(told.converged());
  EXPECT_NEAR(told.clusters[0].scale, 1.12, 0.02) << "two cells at the edge of a footprint of 180";
  EXPECT_LT(told.clusters[0].scale_sigma, 0.02);
  const TrackEstimate untold = end_of(0.0);
  EXPECT_FALSE(untold.converged());
  EXPECT_EQ(untold.clusters[0].scale, 1.0);
  TrackSettings impossible = settings();
  impossible.vehicle.scale_range = 0.5;
  EXPECT_EQ(code_of([&] { Tracker(view_, impossible); }), "parameter-out-of-range");
}

}  // namespace
}  // namespace roadfix
