#include "core/filter/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr double kPi = std::numbers::pi;

ParticleState moved(const auto& motion, ParticleState state = {}, std::uint64_t index = 0) {
  RandomStream random(Draw::kMotion, {7, 1, index});
  motion(state, random);
  return state;
}

struct Scatter {
  std::array<double, 3> mean{};
  Matrix3 covariance{};
};

constexpr int kSamples = 40'000;

/// Of east, north and heading over many particles.
Scatter scatter(const auto& motion) {
  std::vector<std::array<double, 3>> ends;
  Scatter m;
  for (int i = 0; i < kSamples; ++i) {
    const ParticleState s = moved(motion, {}, static_cast<std::uint64_t>(i));
    ends.push_back({s.east_m, s.north_m, s.heading_rad});
    for (std::size_t a = 0; a < 3; ++a) m.mean[a] += ends.back()[a] / kSamples;
  }
  for (const auto& end : ends) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) m.covariance[a][b] += (end[a] - m.mean[a]) * (end[b] - m.mean[b]) / kSamples;
    }
  }
  return m;
}

TEST(PlanarMotion, FollowsEquation4AsManySmallEulerStepsDo) {
  const double v = 20.0;
  const double w = 0.3;
  const double seconds = 4.0;
  const ParticleState end = moved(PlanarMotion{{v, 0.0}, {w, 0.0}, seconds}, {5.0, -3.0, 0.7});
  ParticleState euler{5.0, -3.0, 0.7};
  const int steps = 1'000'000;
  for (int i = 0; i < steps; ++i) {
    const double dt = seconds / steps;
    euler.east_m += dt * v * std::sin(euler.heading_rad);
    euler.north_m += dt * v * std::cos(euler.heading_rad);
    euler.heading_rad += dt * w;
  }
  EXPECT_NEAR(end.east_m, euler.east_m, 1e-3);
  EXPECT_NEAR(end.north_m, euler.north_m, 1e-3);
  EXPECT_NEAR(end.heading_rad, euler.heading_rad, 1e-9);
}

TEST(PlanarMotion, GoesStraightOnWithoutATurn) {
  const ParticleState end = moved(PlanarMotion{{20.0, 0.0}, {0.0, 0.0}, 4.0}, {5.0, -3.0, kPi / 2.0});
  EXPECT_NEAR(end.east_m, 85.0, 1e-12);
  EXPECT_NEAR(end.north_m, -3.0, 1e-12);
  EXPECT_NEAR(end.heading_rad, kPi / 2.0, 1e-12);
}

TEST(PlanarMotion, TurnsOnTheSpot) {
  const ParticleState end = moved(PlanarMotion{{0.0, 0.0}, {kPi / 2.0, 0.0}, 1.0}, {1.0, 2.0, 0.0});
  EXPECT_NEAR(end.east_m, 1.0, 1e-12);
  EXPECT_NEAR(end.north_m, 2.0, 1e-12);
  EXPECT_NEAR(end.heading_rad, kPi / 2.0, 1e-12);
}

TEST(PlanarMotion, SpreadsSpeedAndTurnRateNormally) {
  const Scatter m = scatter(PlanarMotion{{10.0, 2.0}, {0.0, 0.01}, 3.0});
  // Sampling error of a mean is sigma / sqrt(n), of a variance sigma^2 sqrt(2 / n): five times that.
  const double n = kSamples;
  EXPECT_NEAR(m.mean[1], 30.0, 5.0 * 6.0 / std::sqrt(n) + 0.01);
  EXPECT_NEAR(m.covariance[1][1], 36.0, 36.0 * 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(m.covariance[2][2], 0.0009, 0.0009 * 5.0 * std::sqrt(2.0 / n));
}

TEST(PlanarMotion, CarriesParticlesWithTheirWind) {
  const ParticleState end = moved(PlanarMotion{{0.0, 0.0}, {0.0, 0.0}, 2.0}, {0, 0, 0, 3.0, -1.0});
  EXPECT_NEAR(end.east_m, 6.0, 1e-12);
  EXPECT_NEAR(end.north_m, -2.0, 1e-12);
}

/// Of the drift along each axis after ten seconds, m2/s2, begun at none and moved in so many steps.
GridPoint drift_variance(const auto& motion, int steps, int particles) {
  GridPoint variance;
  for (int i = 0; i < particles; ++i) {
    ParticleState state;
    for (int k = 0; k < steps; ++k) {
      RandomStream random(Draw::kMotion, {7, static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(i)});
      motion(state, random);
    }
    variance.east_m += state.drift_east_m_s * state.drift_east_m_s / particles;
    variance.north_m += state.drift_north_m_s * state.drift_north_m_s / particles;
  }
  return variance;
}

TEST(Motion, ChangesTheWindAsMuchInOneStepAsInMany) {
  constexpr int kParticles = 5'000;
  constexpr double kWalk = 0.5;
  constexpr double kVariance = kWalk * kWalk * 10.0;
  const double tolerance = 5.0 * std::sqrt(2.0 / kParticles) * kVariance;
  for (const int steps : {1, 10, 100}) {
    const double seconds = 10.0 / steps;
    const PlanarMotion planar{{0.0, 0.0}, {0.0, 0.0}, seconds, kWalk};
    const OdometryMotion odometry({}, {}, seconds, kWalk);
    for (const GridPoint variance :
         {drift_variance(planar, steps, kParticles), drift_variance(odometry, steps, kParticles)}) {
      EXPECT_NEAR(variance.east_m, kVariance, tolerance) << steps;
      EXPECT_NEAR(variance.north_m, kVariance, tolerance) << steps;
    }
  }
}

std::string refusal(const Odometry& odometry, const OdometryCovariance& covariance) {
  try {
    const OdometryMotion motion(odometry, covariance);
  } catch (const InvalidInput& error) {
    return error.code();
  }
  return "taken";
}

TEST(OdometryMotion, MovesInTheBodyFrame) {
  const ParticleState end =
      moved(OdometryMotion({10.0, 2.0, Angle::degrees(30.0)}, {}), {0.0, 0.0, Angle::degrees(90.0).radians()});
  EXPECT_NEAR(end.east_m, 10.0, 1e-12);
  EXPECT_NEAR(end.north_m, -2.0, 1e-12);
  EXPECT_NEAR(Angle::radians(end.heading_rad).degrees(), 120.0, 1e-9);
}

TEST(OdometryMotion, SpreadsAsItsCovarianceSays) {
  const OdometryCovariance covariance{{{4.0, 1.0, 0.02}, {1.0, 1.0, -0.03}, {0.02, -0.03, 0.01}}};
  const Scatter m = scatter(OdometryMotion({50.0, 0.0, Angle()}, covariance));
  // Heading 0: east is right, north is forward.
  const double tolerance = 5.0 * std::sqrt(2.0 / kSamples);
  EXPECT_NEAR(m.covariance[1][1], 4.0, 4.0 * tolerance);
  EXPECT_NEAR(m.covariance[0][0], 1.0, tolerance);
  EXPECT_NEAR(m.covariance[0][1], 1.0, 2.0 * tolerance);
  EXPECT_NEAR(m.covariance[1][2], 0.02, 0.2 * tolerance);
  EXPECT_NEAR(m.covariance[0][2], -0.03, 0.1 * tolerance);
}

TEST(OdometryMotion, SpreadsHeadingsAsToldHoweverLittleIsKnownOfThePlace) {
  for (const double place_m : {1.0, 300.0, 1e5}) {
    const double turn = Angle::degrees(1.0).radians();
    const double shared = 0.6 * place_m * turn;
    const Scatter m = scatter(OdometryMotion(
        {}, {{{place_m * place_m, 0.0, 0.0}, {0.0, place_m * place_m, shared}, {0.0, shared, turn * turn}}}));
    const double tolerance = 5.0 * std::sqrt(2.0 / kSamples);
    EXPECT_NEAR(m.covariance[2][2] / (turn * turn), 1.0, tolerance) << place_m;
    EXPECT_NEAR(m.covariance[0][2] / shared, 1.0, 2.0 * tolerance) << place_m;
  }
}

TEST(OdometryMotion, TakesACovarianceOfNumbersOfSinglePrecision) {
  const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  const double shared = rounded(0.3);
  const double turn = rounded(0.0009);
  EXPECT_EQ(refusal({}, {{{100.0, 0.0, 0.0}, {0.0, 100.0, shared}, {0.0, shared, turn}}}), "taken");
}

TEST(OdometryMotion, TakesACovarianceThatLeavesADirectionWithoutError) {
  const OdometryCovariance rank1{{{4.0, 2.0, 0.0}, {2.0, 1.0, 0.0}, {0.0, 0.0, 0.0}}};
  const ParticleState end = moved(OdometryMotion({0.0, 0.0, Angle()}, rank1));
  EXPECT_NEAR(end.north_m, 2.0 * end.east_m, 1e-9);
  EXPECT_EQ(end.heading_rad, 0.0);
}

TEST(OdometryMotion, RefusesWhatIsNoCovarianceAndNoNumber) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal({}, {{{-1.0, 0, 0}, {0, 1.0, 0}, {0, 0, 1.0}}}), "covariance-not-positive");
  EXPECT_EQ(refusal({}, {{{1.0, 2.0, 0}, {2.0, 1.0, 0}, {0, 0, 1.0}}}), "covariance-not-positive");
  EXPECT_EQ(refusal({}, {{{1.0, 0.5, 0}, {0.0, 1.0, 0}, {0, 0, 1.0}}}), "covariance-not-positive") << "not symmetric";
  EXPECT_EQ(refusal({}, {{{0.0, 0.5, 0}, {0.5, 1.0, 0}, {0, 0, 1.0}}}), "covariance-not-positive");
  EXPECT_EQ(refusal({kNaN, 0.0, Angle()}, {}), "odometry-not-finite");
  EXPECT_EQ(refusal({0.0, kNaN, Angle()}, {}), "odometry-not-finite");
  EXPECT_EQ(refusal({0.0, 0.0, Angle::radians(kNaN)}, {}), "odometry-not-finite");
  EXPECT_EQ(refusal({}, {{{kNaN, 0, 0}, {0, 1.0, 0}, {0, 0, 1.0}}}), "odometry-not-finite");
  EXPECT_EQ(refusal({}, {}), "taken");
}

TEST(ConstantVelocityMotion, TakesUpTheVelocityOfTheBodyAlongItsHeading) {
  ConstantVelocityMotion motion{2.0, 0.0, 0.0};
  motion.joins = {10.0, 3.0};
  const ParticleState end = moved(motion, {0.0, 0.0, std::numbers::pi / 2, 1.0, -1.0});  // to the east
  EXPECT_NEAR(end.drift_east_m_s, 11.0, 1e-12);
  EXPECT_NEAR(end.drift_north_m_s, -4.0, 1e-12);
  EXPECT_NEAR(end.east_m, 22.0, 1e-12);
  EXPECT_NEAR(end.north_m, -8.0, 1e-12);
  const ParticleState north = moved(motion);
  EXPECT_NEAR(north.drift_east_m_s, 3.0, 1e-12);
  EXPECT_NEAR(north.drift_north_m_s, 10.0, 1e-12);
}

TEST(ConstantVelocityMotion, SpreadsAsMuchInOneStepAsInMany) {
  constexpr int kParticles = 20'000;
  for (const int steps : {1, 2, 8}) {
    const ConstantVelocityMotion motion{4.0 / steps, 3.0, 0.0};
    double places = 0.0;
    double velocities = 0.0;
    double both = 0.0;
    for (int i = 0; i < kParticles; ++i) {
      ParticleState state;
      for (int k = 0; k < steps; ++k) {
        RandomStream random(Draw::kMotion, {7, static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(i)});
        motion(state, random);
      }
      places += state.east_m * state.east_m / kParticles;
      velocities += state.drift_east_m_s * state.drift_east_m_s / kParticles;
      both += state.east_m * state.drift_east_m_s / kParticles;
    }
    // Of white acceleration q over t: q t^3 / 3, q t and q t^2 / 2. Five sigma of what 20,000 draws tell.
    EXPECT_NEAR(places, 9.0 * 64.0 / 3.0, 5.0 * std::sqrt(2.0 / kParticles) * 192.0) << steps;
    EXPECT_NEAR(velocities, 9.0 * 4.0, 5.0 * std::sqrt(2.0 / kParticles) * 36.0) << steps;
    EXPECT_NEAR(both, 9.0 * 16.0 / 2.0, 5.0 * std::sqrt(2.0 / kParticles) * 83.0) << steps;
  }
}

TEST(ConstantVelocityMotion, GoesOnAsItWent) {
  const ParticleState end = moved(ConstantVelocityMotion{2.0, 0.0, 0.0}, {1.0, 1.0, 0.5, 10.0, -4.0});
  EXPECT_NEAR(end.east_m, 21.0, 1e-12);
  EXPECT_NEAR(end.north_m, -7.0, 1e-12);
  EXPECT_EQ(end.heading_rad, 0.5);
}

TEST(ConstantVelocityMotion, TurnsByWhatIsDoubtedOfItsTurnAndByMoreTheLongerItTakes) {
  ConstantVelocityMotion motion{4.0, 0.0, 0.1};
  motion.turn_rad = {0.3, 0.15};
  const Scatter m = scatter(motion);
  const double variance = 0.1 * 0.1 * 4.0 + 0.15 * 0.15;
  EXPECT_NEAR(m.mean[2], 0.3, 5.0 * std::sqrt(variance / kSamples));
  EXPECT_NEAR(m.covariance[2][2], variance, 5.0 * std::sqrt(2.0 / kSamples) * variance);
}

TEST(ConstantVelocityMotion, TurnsTheBodyAndNotItsWay) {
  ConstantVelocityMotion motion{2.0, 0.0, 0.0};
  motion.turn_rad = {0.3, 0.0};
  const ParticleState end = moved(motion, {1.0, 1.0, 0.5, 10.0, -4.0});
  EXPECT_NEAR(end.heading_rad, 0.8, 1e-12);
  EXPECT_NEAR(end.east_m, 21.0, 1e-12);
  EXPECT_NEAR(end.north_m, -7.0, 1e-12);
}

TEST(ScaleWalk, GrowsWithTheRootOfTimeAndStaysWithinItsRange) {
  double sum2 = 0.0;
  double max = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    sum2 += std::pow(moved(ScaleWalk{4.0, 0.01, 1.0}, {}, index).log_scale, 2.0) / kSamples;
    max = std::max(max, std::abs(moved(ScaleWalk{4.0, 0.1, 0.15}, {}, index).log_scale));
  }
  EXPECT_NEAR(std::sqrt(sum2), 0.02, 0.0004) << "five times the error of a standard deviation of 40,000 draws";
  EXPECT_EQ(max, 0.15);
}

}  // namespace
}  // namespace roadfix
