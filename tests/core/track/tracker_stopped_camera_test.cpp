// Flights on whose camera nobody can rely any more.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "core/track/tracker.hpp"
#include "tests/core/track/stopped_camera.hpp"
#include "tests/core/track/track_fixture.hpp"

namespace roadfix {
namespace {

using testing::encoded_anew;
using testing::Flight;
using testing::noisy;
using testing::of_bytes;
using testing::random_sketch;
using testing::Track;

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
