#include "core/track/odometry_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadfix {
namespace {

/// Of the variances forward, to the right (m) and of the turn (degrees).
void expect_sigmas(const OdometryCovariance& covariance, double metres, double degrees) {
  const double turn = Angle::degrees(degrees).radians();
  const OdometryCovariance expected{
      {{metres * metres, 0.0, 0.0}, {0.0, metres * metres, 0.0}, {0.0, 0.0, turn * turn}}};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      EXPECT_NEAR(covariance[row][column], expected[row][column], 1e-12) << row << ", " << column;
    }
  }
}

TEST(OdometryNoise, IsFivePercentAnd30CentimetresOrHalfADegree) {
  const VehicleNoise unsaid;
  expect_sigmas(covariance_of({0.0, 0.0, {}}, 1.0, unsaid), 0.3, 0.5);
  expect_sigmas(covariance_of({0.0, 0.0, {}}, 0.0, unsaid), 0.3, 0.5);
  expect_sigmas(covariance_of({30.0, -40.0, Angle::degrees(-20.0)}, 0.2, unsaid), 0.3 + 2.5, 0.5 + 1.0);
}

TEST(OdometryNoise, IsAboutThatOfStepsOfASecondInAStepOfManySeconds) {
  const VehicleNoise unsaid;
  expect_sigmas(covariance_of({0.0, 0.0, {}}, 64.0, unsaid), 8.0 * 0.3, 8.0 * 0.5);
  expect_sigmas(covariance_of({30.0, -40.0, Angle::degrees(-20.0)}, 64.0, unsaid), 2.4 + 2.5, 4.0 + 1.0);
}

TEST(OdometryNoise, IsTheShareThatIsTold) {
  VehicleNoise vehicle;
  vehicle.odometry_share = 0.2;
  expect_sigmas(covariance_of({0.0, 100.0, Angle::degrees(10.0)}, 1.0, vehicle), 0.3 + 20.0, 0.5 + 2.0);
}

TEST(OdometryNoise, IsTheSameShareOfAllThatWasTravelledSinceAFrame) {
  const VehicleNoise unsaid;
  double variance_m2 = 0.0;
  double variance_with_frames_m2 = 0.0;
  for (int step = 0; step < 40; ++step) {
    variance_m2 += covariance_of({9.0, 12.0, {}}, 1.0, unsaid, 15.0 * step)[1][1];
    variance_with_frames_m2 += covariance_of({9.0, 12.0, {}}, 1.0, unsaid)[1][1];
  }
  const double share_of_each_m = 0.05 * 15.0;
  const double share_of_all_m = 0.05 * 600.0;
  EXPECT_NEAR(variance_m2 - variance_with_frames_m2,
              share_of_all_m * share_of_all_m - 40.0 * share_of_each_m * share_of_each_m, 1e-9);
}

TEST(OdometryNoise, IsHalfOfWhatLostStepsMayHaveMoved) {
  const OdometryCovariance of_one{{{1.0, 0.5, 0.0}, {0.5, 4.0, 0.0}, {0.0, 0.0, 0.01}}};
  const auto [odometry, covariance] = with_lost_steps({6.0, 8.0, Angle::degrees(10.0)}, of_one, 2.0);
  EXPECT_DOUBLE_EQ(odometry.turn.degrees(), 30.0);
  EXPECT_DOUBLE_EQ(covariance[0][0], 3.0 * 1.0 + 10.0 * 10.0);
  EXPECT_DOUBLE_EQ(covariance[0][1], 3.0 * 0.5);
  EXPECT_DOUBLE_EQ(covariance[1][1], 3.0 * 4.0 + 10.0 * 10.0);
  EXPECT_DOUBLE_EQ(covariance[2][2], 3.0 * 0.01 + 2.0 * 0.3 * 0.3);
}

TEST(OdometryNoise, LaysLostStepsOneAfterAnother) {
  for (const double turn_deg : {0.0, 15.0, -40.0, 180.0, 1e-7, 360.0}) {
    const Odometry one{12.0, 5.0, Angle::degrees(turn_deg)};
    for (const int lost : {0, 1, 3, 6}) {
      double forward = 0.0;
      double right = 0.0;
      for (int k = 0; k <= lost; ++k) {
        const double turned = k * one.turn.radians();
        forward += one.forward_m * std::cos(turned) - one.right_m * std::sin(turned);
        right += one.forward_m * std::sin(turned) + one.right_m * std::cos(turned);
      }
      const Odometry all = with_lost_steps(one, {}, lost).first;
      EXPECT_NEAR(all.forward_m, forward, 1e-6) << turn_deg << ' ' << lost;
      EXPECT_NEAR(all.right_m, right, 1e-6) << turn_deg << ' ' << lost;
      EXPECT_DOUBLE_EQ(all.turn.radians(), (1 + lost) * one.turn.radians());
    }
  }
}

}  // namespace
}  // namespace roadfix
