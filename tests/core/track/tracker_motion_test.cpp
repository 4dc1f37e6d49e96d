// How a track moves where odometry does not tell all of it, or nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "core/filter/clusters.hpp"
#include "tests/core/track/track_fixture.hpp"
#include "tests/support/repeats.hpp"

namespace roadfix {
namespace {

using testing::Flight;
using testing::repeats;
using testing::Track;

TEST_F(Track, LearnsTheWindWhereOdometryIsRelativeToTheAir) {
  TrackSettings blown = settings();
  blown.vehicle.wind = {6.0};
  const Tracker tracker(view_, blown);
  Flight flight(map_, start_, 4);
  int claims = 0;
  for (int i = 0; i < 30; ++i) {
    const GridPose& pose = flight.pose();
    flight.jump_to({{pose.position.east_m + 7.0, pose.position.north_m - 4.0}, pose.heading});
    const TrackEstimate estimate = advance(tracker, flight.step());
    claims += estimate.converged() ? 1 : 0;
    EXPECT_LT(error_m(estimate, flight.pose()), 12.0) << "step " << i;
  }
  EXPECT_GE(claims, 24);
  const Particles& p = state_.filter.particles;
  EXPECT_NEAR(std::accumulate(p.drift_east_m_s.begin(), p.drift_east_m_s.end(), 0.0) / static_cast<double>(p.size()),
              7.0, 1.5);
}

TEST_F(Track, GoesOnByEquation4OrConstantVelocityWithoutOdometry) {
  TrackSettings planar = settings();
  planar.vehicle.planar = VehicleNoise::Planar{{20.0, 1.0}, {0.0, 0.05}};
  const Tracker tracker(view_, planar);
  Flight flight(map_, start_, 9);
  fly(tracker, flight, 1);
  TrackEstimate last;
  for (int i = 0; i < 15; ++i) {
    StepInput step = flight.step();
    step.odometry.reset();
    last = advance(tracker, step);
  }
  EXPECT_LT(error_m(last, flight.pose()), 15.0);
}

/// Flies on at 20 m a second without frames once it has claimed a place.
class TrackUnseen : public Track {
 protected:
  /// Hands over each estimate that claims a place, with the true pose. `told`: the odometry, by the number of the step.
  void fly_unseen(std::uint64_t seed, int steps, const std::function<std::optional<Odometry>(int)>& told,
                  const std::function<void(const TrackEstimate&, const GridPose&)>& claimed) {
    const Tracker tracker(view_, settings_);
    Flight flight(map_, start_, seed);
    state_ = {};
    ASSERT_TRUE(fly(tracker, flight, 8).converged()) << seed;
    for (int i = 0; i < steps; ++i) {
      const ::testing::ScopedTrace trace(__FILE__, __LINE__, fmt::format("seed {}, {} s", seed, i));
      const GridPose before = flight.pose();
      StepInput step = flight.step(false);
      flight.jump_to(moved(before, {20.0, 0.0, {}}));
      step.odometry = told(i);
      const TrackEstimate estimate = advance(tracker, step);
      if (estimate.converged()) claimed(estimate, flight.pose());
    }
  }

  TrackSettings settings_ = settings();
};

/// 1 sigma in that direction. The ellipse is told from true north, a degree off at most.
double sigma_along_m(const Ellipse& ellipse, Angle heading) {
  const double off = (heading - ellipse.heading).radians();
  return std::hypot(ellipse.sigma_m[0] * std::cos(off), ellipse.sigma_m[1] * std::sin(off));
}

TEST_F(TrackUnseen, CountsAScaleOfItsOdometryThatIsWrongByAllThatItFlies) {
  int claims = 0;
  const auto too_long = [](int i) {
    return Odometry{i % 2 == 0 ? 20.9 : 21.1, 0.0, {}};  // by the share of 5 %, 1 sigma
  };
  for (std::uint64_t seed = 21; seed < 21 + repeats(4U); ++seed) {
    fly_unseen(seed, 50, too_long, [&](const TrackEstimate& estimate, const GridPose& truth) {
      ++claims;
      EXPECT_LT(error_m(estimate, truth), 2.5 * sigma_along_m(estimate.clusters[0].ellipse, truth.heading));
    });
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(claims, static_cast<int>(repeats(4U)) * 15) << "300 m";
}

TEST_F(TrackUnseen, CountsASpeedThatIsToldWronglyByAllThatItFlies) {
  settings_.vehicle.planar = VehicleNoise::Planar{{21.0, 1.0}, {0.0, Angle::degrees(0.5).radians()}};  // by 1 sigma
  int claims = 0;
  const auto nothing = [](int) { return std::nullopt; };
  for (std::uint64_t seed = 21; seed < 21 + repeats(4U); ++seed) {
    fly_unseen(seed, 50, nothing, [&](const TrackEstimate& estimate, const GridPose& truth) {
      ++claims;
      EXPECT_LT(error_m(estimate, truth), 2.5 * sigma_along_m(estimate.clusters[0].ellipse, truth.heading));
    });
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(claims, static_cast<int>(repeats(4U)) * 10) << "200 m";
}

TEST_F(TrackUnseen, SoonClaimsNoPlaceWhereAnEstimatorThatHasStoppedRepeatsItsMovement) {
  int claims = 0;
  const auto turning = [](int) { return Odometry{20.0, 0.0, Angle::degrees(6.0)}; };  // as when the estimator stopped
  for (std::uint64_t seed = 21; seed < 21 + repeats(4U); ++seed) {
    fly_unseen(seed, 30, turning, [&](const TrackEstimate& estimate, const GridPose& truth) {
      ++claims;
      EXPECT_LT(error_m(estimate, truth), 2.5 * estimate.clusters[0].ellipse.sigma_m[0]);
    });
    if (HasFatalFailure()) return;
  }
  EXPECT_LE(claims, static_cast<int>(repeats(4U)) * 6);
}

TEST_F(Track, GoesOnAsItFlewWhereOdometryEndsAndSoonClaimsNoPlace) {
  int claims = 0;
  for (std::uint64_t seed = 21; seed < 21 + repeats(4U); ++seed) {
    const Tracker tracker(view_, settings());
    Flight flight(map_, start_, seed);
    state_ = {};
    const bool claimed = fly(tracker, flight, 8).converged();
    claims += claimed ? 1 : 0;
    for (int second = 1; second <= 12; ++second) {
      StepInput step = flight.step(false);  // 20 m/s, turning
      step.odometry.reset();
      const TrackEstimate estimate = advance(tracker, step);
      if (second == 1) {
        EXPECT_EQ(estimate.converged(), claimed);
      }
      if (estimate.converged()) {
        EXPECT_LT(error_m(estimate, flight.pose()), 15.0) << "seed " << seed << ", second " << second;
      }
      EXPECT_FALSE(estimate.converged() && second > 4) << "seed " << seed;
    }
  }
  EXPECT_GT(claims, repeats(4) / 2);
}

TEST_F(Track, CountsThatACopterWhichHoveredMaySetOffOnceNothingTellsItsMovement) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 21);
  fly(tracker, flight, 8);
  flight.step_m = 0.0;
  EXPECT_TRUE(fly(tracker, flight, 3).converged());
  for (int second = 1; second <= 12; ++second) {
    const GridPose before = flight.pose();
    StepInput step = flight.step(false);
    step.odometry.reset();
    flight.jump_to(moved(before, {std::min(3.0 * second - 1.5, 10.0), 0.0, {}}));  // by 3 m/s2, to 10 m/s
    const TrackEstimate estimate = advance(tracker, step);
    EXPECT_TRUE(estimate.converged() || second > 1);
    if (estimate.converged()) {
      EXPECT_LT(error_m(estimate, flight.pose()), 2.5 * estimate.clusters[0].ellipse.sigma_m[0]) << second << " s";
    }
  }
}

TEST_F(Track, ClaimsNoPlaceOfTheParticlesThatLagBehindWhereOthersHaveLeftTheGroundAround) {
  Flight flight(map_, start_, 1);
  ASSERT_TRUE(fly(Tracker(view_, settings()), flight, 10).converged());
  const TrackerState before = state_;
  StepInput hover = flight.step(false);
  hover.odometry = Odometry{};
  const Cluster belief = heaviest_of(before.filter.particles);
  const GridPoint at = belief.mean.position;
  const GridBox box = map_.geometry.box();
  const double to_rim_m = std::min({at.east_m - box.min.east_m, box.max.east_m - at.east_m,
                                    at.north_m - box.min.north_m, box.max.north_m - at.north_m});
  for (const double sigmas : {1.0, 20.0}) {
    TrackSettings ending = settings();  // so far from the belief
    ending.beyond_map_m = sigmas * belief.sigma_m() - to_rim_m;
    state_ = before;
    const Tracker tracker(view_, ending);
    EXPECT_EQ(advance(tracker, hover).converged(), sigmas > 10.0) << sigmas;
    EXPECT_EQ(state_.filter.resets, before.filter.resets) << sigmas;
    const std::vector<double>& weights = state_.filter.particles.weight;
    const auto left = static_cast<std::size_t>(std::ranges::count(weights, 0.0));
    EXPECT_EQ(left == 0, sigmas > 10.0) << sigmas;
    EXPECT_EQ(tracker.particles(state_, weights.size()).size(), weights.size() - left) << "none of those that left";
  }
}

TEST_F(Track, FollowsFramesWithoutOdometryAndKeepsNoWindOfThem) {
  for (std::uint64_t seed = 31; seed < 31 + repeats(3U); ++seed) {
    const Tracker tracker(view_, settings());
    Flight flight(map_, start_, seed);
    state_ = {};
    fly(tracker, flight, 8);
    for (int i = 0; i < 10; ++i) {
      StepInput step = flight.step();
      step.odometry.reset();
      EXPECT_LT(error_m(advance(tracker, step), flight.pose()), 15.0) << "seed " << seed << ", step " << i;
    }
    EXPECT_FALSE(state_.motion.odometry_is_wrong);
    for (int i = 0; i < 6; ++i) {
      EXPECT_LT(error_m(advance(tracker, flight.step(false)), flight.pose()), 20.0)
          << "seed " << seed << ", step " << i;
    }
  }
}

}  // namespace
}  // namespace roadfix
