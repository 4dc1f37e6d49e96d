#include "core/locate/track_motion.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

const AcceptanceRegion kFlight{
    {{{0.0, 0.0}, {1000.0, 1000.0}}, std::nullopt, Angle(), Angle::degrees(180.0)}, 500.0, 0.0, 0.0};
const LearnedMotion kFlewAt20MS{BodyVelocity{16.0, 12.0}, false, false};

Filter filter_at(const StepMotion& motion, GridPose pose) {
  Filter filter(FilterOptions::paper(100), motion.region(), 1);
  filter.start_anew_from(std::vector<Proposal>{{pose}}, 0.0, kFlight.poses);
  return filter;
}

TEST(StepMotion, GivesNewParticlesTheWindOrTheWholeVelocityWhereNothingTellsIt) {
  VehicleNoise vehicle;
  vehicle.wind = Wind::of(3.0, 0.0);
  EXPECT_EQ(StepMotion(vehicle, kFlight, {Odometry{20.0, 0.0, {}}, {}, 1.0}, kFlewAt20MS).region().drift_sigma_m_s,
            3.0);
  EXPECT_EQ(StepMotion(vehicle, kFlight, {{}, {}, 1.0}, kFlewAt20MS).region().drift_sigma_m_s, 20.0);
  vehicle.planar = VehicleNoise::Planar{{-15.0, 1.0}, {}};
  const StepMotion planar(vehicle, kFlight, {{}, {}, 1.0}, {});
  EXPECT_EQ(planar.region().drift_sigma_m_s, 3.0);
  EXPECT_EQ(planar.speed_m_s(), 15.0);
}

TEST(StepMotion, FollowsOdometryAndRemembersTheVelocity) {
  const VehicleNoise vehicle;
  StepMotion motion(vehicle, kFlight, {Odometry{30.0, 40.0, {}}, OdometryCovariance{}, 2.0}, {});
  Filter filter = filter_at(motion, {{500.0, 500.0}, Angle()});
  const double north_m = filter.particles().north_m[7];
  EXPECT_EQ(motion.move(filter), 1.0);
  EXPECT_NEAR(filter.particles().north_m[7] - north_m, 30.0, 0.1) << "but for the heading of the draw";
  EXPECT_EQ(motion.learned().velocity, (BodyVelocity{15.0, 20.0}));
  EXPECT_EQ(motion.speed_m_s(), 25.0);
  EXPECT_FALSE(motion.learned().coasts);
}

TEST(StepMotion, TakesNoVelocityFromAStepTooShortToTellOne) {
  const VehicleNoise vehicle;
  StepMotion motion(vehicle, kFlight, {Odometry{15.0, 0.0, {}}, {}, 0.001}, kFlewAt20MS);
  Filter filter = filter_at(motion, {{500.0, 500.0}, Angle()});
  motion.move(filter);
  EXPECT_EQ(motion.learned().velocity, kFlewAt20MS.velocity);
}

TEST(StepMotion, CountsLostStepsAsLikeThisOne) {
  const VehicleNoise vehicle;
  StepMotion motion(vehicle, kFlight, {Odometry{10.0, 0.0, {}}, {}, 3.0, 2}, {});
  Filter filter = filter_at(motion, {{500.0, 500.0}, Angle()});
  motion.move(filter);
  EXPECT_EQ(motion.learned().velocity, (BodyVelocity{10.0, 0.0}));
  EXPECT_FALSE(motion.covers_ground());
}

TEST(StepMotion, LearnsADriftOnlyOfOdometry) {
  const VehicleNoise vehicle;
  StepMotion flown(vehicle, kFlight, {Odometry{20.0, 0.0, {}}, {}, 1.0}, kFlewAt20MS);
  Filter filter = filter_at(flown, {{500.0, 500.0}, Angle()});
  EXPECT_TRUE(flown.covers_ground());
  flown.learn_drift(filter);
  EXPECT_TRUE(flown.learned().drifts);
  EXPECT_EQ(flown.region().drift_sigma_m_s, 6.0) << "three tenths of the speed";
  EXPECT_FALSE(flown.covers_ground());

  StepMotion coasting(vehicle, kFlight, {{}, {}, 1.0}, kFlewAt20MS);
  const Particles before = filter.particles();
  coasting.learn_drift(filter);
  coasting.try_drifts(filter);
  EXPECT_FALSE(coasting.learned().drifts);
  EXPECT_TRUE(filter.particles() == before);
}

TEST(StepMotion, TellsTheWayOfAStep) {
  const VehicleNoise vehicle;
  const auto way_m = [&](const ToldMotion& told) { return StepMotion(vehicle, kFlight, told, kFlewAt20MS).way_m(); };
  EXPECT_DOUBLE_EQ(way_m({Odometry{3.0, -4.0, {}}, {}, 1.0}), 5.0);
  EXPECT_DOUBLE_EQ(way_m({Odometry{3.0, -4.0, {}}, {}, 1.0, 2}), 15.0) << "two steps of the same kind were lost";
  EXPECT_DOUBLE_EQ(way_m({{}, {}, 2.5}), 50.0) << "on as it flew";
}

}  // namespace
}  // namespace roadfix
