#include "core/track/track_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace roadfix {
namespace {

const AcceptanceRegion kFlight{
    {{{0.0, 0.0}, {1000.0, 1000.0}}, std::nullopt, Angle(), Angle::degrees(180.0)}, 500.0, 0.0, 0.0};
const LearnedMotion kFlewAt20MS{BodyVelocity{16.0, 12.0}, 0.0, false, false, 0.0};

Filter filter_at(const StepMotion& motion, GridPose pose) {
  Filter filter(FilterOptions::paper(100), motion.region(), 1);
  filter.start_anew_from(std::vector<Proposal>{{pose}}, 0.0, kFlight.poses);
  return filter;
}

TEST(StepMotion, GivesNewParticlesTheWindOrTheWholeVelocityWhereNothingTellsIt) {
  VehicleNoise vehicle;
  vehicle.wind = {3.0};
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

TEST(StepMotion, CarriesAReachByTheOdometryAndWhatItDoesNotFeel) {
  const Reach start{{500.0, 500.0}, Angle(), 30.0, Angle()};
  const OdometryCovariance exact_turn{{{1.0, 0, 0}, {0, 4.0, 0}, {0, 0, 0}}};
  VehicleNoise vehicle;
  vehicle.wind = {3.0};
  const auto carried = [&](const ToldMotion& told) {
    Reach reach = start;
    StepMotion(vehicle, kFlight, told, kFlewAt20MS).carry(reach);
    return reach;
  };
  const Reach told = carried({Odometry{40.0, 0.0, {}}, exact_turn, 2.0});
  EXPECT_EQ(told.position, (GridPoint{500.0, 540.0}));
  EXPECT_NEAR(told.radius_m, 30.0 + 2.0 * 2.0 + 2.0 * 3.0 * 2.0, 1e-9) << "two sigma of odometry and of the wind";
  const Reach lost = carried({Odometry{40.0, 0.0, {}}, exact_turn, 4.0, 1});
  EXPECT_EQ(lost.position, (GridPoint{500.0, 580.0}));
  EXPECT_GT(lost.radius_m, told.radius_m + 2.0 * 20.0) << "half of a lost step, 1 sigma";
  const Reach untold = carried({{}, {}, 2.0});
  EXPECT_EQ(untold.position, start.position);
  EXPECT_GE(untold.radius_m, 30.0 + 2.0 * 40.0);
  EXPECT_NEAR(untold.turned_at_most().degrees(), 180.0, 1e-9);
}

/// By how much a reach grows in a second without odometry.
double strays_by_m(const VehicleNoise& vehicle, const LearnedMotion& learned) {
  Reach reach{{500.0, 500.0}, Angle(), 30.0, Angle()};
  StepMotion(vehicle, kFlight, {{}, {}, 1.0}, learned).carry(reach);
  return reach.radius_m - 30.0;
}

TEST(StepMotion, LosesAReachWhereNobodyKnowsHowFastTheVehicleIs) {
  EXPECT_GT(strays_by_m({}, {}), Reach::kMaxM);
  const LearnedMotion hovered{BodyVelocity{}, 0.0, false, false, 0.0};
  EXPECT_GE(strays_by_m({}, hovered), 0.5 * 9.8) << "it flies off by as much as it weighs";
  LearnedMotion untold = hovered;
  untold.coasted_s = 4.0;
  EXPECT_GE(strays_by_m({}, untold), 0.5 * 9.8 * (5.0 * 5.0 - 4.0 * 4.0)) << "faster from second to second";
  EXPECT_LT(strays_by_m({}, untold), 0.5 * 11.0 * (5.0 * 5.0 - 4.0 * 4.0)) << "but for this second alone";
}

TEST(StepMotion, CarriesAReachByASpeedThatIsToldAsFarAsThatMayBeOff) {
  VehicleNoise vehicle;
  vehicle.planar = VehicleNoise::Planar{{0.0, 12.0}, {}};
  EXPECT_GE(strays_by_m(vehicle, {}), 2.0 * 12.0);
  vehicle.wind = {7.0};
  EXPECT_GE(strays_by_m(vehicle, {}), 2.0 * 12.0 + 2.0 * 7.0);
  vehicle.planar->speed_m_s = {-20.0, 0.0};
  EXPECT_GE(strays_by_m(vehicle, {}), 20.0 + 2.0 * 7.0);
  EXPECT_LT(strays_by_m(vehicle, {}), Reach::kMaxM);
}

TEST(StepMotion, TakesNoVelocityFromAStepTooShortToTellOne) {
  const VehicleNoise vehicle;
  StepMotion motion(vehicle, kFlight, {Odometry{15.0, 0.0, {}}, {}, 0.001}, kFlewAt20MS);
  Filter filter = filter_at(motion, {{500.0, 500.0}, Angle()});
  motion.move(filter);
  EXPECT_EQ(motion.learned().velocity, kFlewAt20MS.velocity);
}

TEST(StepMotion, TakesOdometryThatRepeatsItselfUnseenForThatOfAnEstimatorThatHasStopped) {
  const VehicleNoise vehicle;
  const Odometry turning{16.0, 2.0, Angle::degrees(4.0)};
  StepMotion first(vehicle, kFlight, {turning, {}, 1.0}, {});
  Filter filter = filter_at(first, {{500.0, 500.0}, Angle()});
  first.move(filter);
  const LearnedMotion unseen = first.learned();
  const auto is_believed = [&](const Odometry& odometry, double seconds, const LearnedMotion& before) {
    return StepMotion(vehicle, kFlight, {odometry, {}, seconds}, before).told().odometry.has_value();
  };
  EXPECT_FALSE(is_believed(turning, 1.0, unseen));
  EXPECT_FALSE(is_believed({16.001, 2.0, Angle::degrees(4.0)}, 1.0, unseen)) << "rounded otherwise";
  EXPECT_TRUE(is_believed({16.01, 2.0, Angle::degrees(4.0)}, 1.0, unseen));
  EXPECT_TRUE(is_believed({16.0, 2.01, Angle::degrees(4.0)}, 1.0, unseen));
  EXPECT_TRUE(is_believed({16.0, 2.0, Angle::degrees(4.01)}, 1.0, unseen));
  EXPECT_TRUE(is_believed(turning, 1.1, unseen)) << "of another velocity";
  const LearnedMotion straight{BodyVelocity{16.0, 2.0}, 0.0, false, false, 0.0, 32.0};
  EXPECT_FALSE(is_believed({17.6, 2.2, {}}, 1.1, straight)) << "of the same velocity for longer";
  EXPECT_TRUE(is_believed({0.0, 0.0, {}}, 1.0, {BodyVelocity{}, 0.0, false, false, 0.0, 32.0})) << "it stands";
  first.see();
  EXPECT_TRUE(is_believed(turning, 1.0, first.learned())) << "a frame tells whether it is right";
}

TEST(StepMotion, CountsLostStepsAsLikeThisOne) {
  const VehicleNoise vehicle;
  StepMotion motion(vehicle, kFlight, {Odometry{10.0, 0.0, {}}, {}, 3.0, 2}, {});
  Filter filter = filter_at(motion, {{500.0, 500.0}, Angle()});
  motion.move(filter);
  EXPECT_EQ(motion.learned().velocity, (BodyVelocity{10.0, 0.0}));
  EXPECT_FALSE(motion.odometry_is_complete());
}

TEST(StepMotion, TakesTheErrorOfOdometryForThatOfItsOwnStepHoweverManyWereLost) {
  const VehicleNoise vehicle;
  const auto error = [&](double seconds, std::int64_t lost_steps) {
    const ToldMotion told{Odometry{10.0, 0.0, {}}, {}, seconds, lost_steps};
    return StepMotion(vehicle, kFlight, told, {}).odometry_covariance();
  };
  EXPECT_EQ(error(8.0, 3), error(2.0, 0));
  EXPECT_NE(error(8.0, 3), error(8.0, 0));
}

/// Where it flew on from (500, 500) to the east for a second, and what it learned.
std::pair<FilterState, LearnedMotion> coasted(double speed_m_s) {
  const VehicleNoise vehicle;
  StepMotion coasting(vehicle, kFlight, {{}, {}, 1.0}, {BodyVelocity{speed_m_s, 0.0}, 0.0, false, false, 0.0});
  FilterOptions options = FilterOptions::paper(5'000);
  options.injected_share = 0.0;
  Filter filter(options, kFlight, 1);
  filter.start_anew_from(std::vector<Proposal>{{{{500.0, 500.0}, Angle::degrees(90.0)}}}, 0.0, kFlight.poses);
  coasting.move(filter);
  return {filter.state(), coasting.learned()};
}

TEST(StepMotion, GoesOnAsItFlewAndDoubtsHalfOfItsSpeedAndThreeMetresASecondAtLeast) {
  for (const auto& [speed_m_s, sigma_m_s] : {std::pair(20.0, 10.0), {1.0, 3.0}, {0.0, 3.0}}) {
    const Particles p = coasted(speed_m_s).first.particles;
    const auto n = static_cast<double>(p.size());
    double east_m = 0.0;
    double east_m_s = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      east_m += (p.east_m[i] - 500.0) / n;
      east_m_s += p.drift_east_m_s[i] / n;
      squares += p.drift_north_m_s[i] * p.drift_north_m_s[i] / n;
    }
    const double five_errors = 5.0 * sigma_m_s / std::sqrt(n);
    EXPECT_NEAR(east_m, speed_m_s, five_errors);
    EXPECT_NEAR(east_m_s, speed_m_s, five_errors);
    EXPECT_NEAR(std::sqrt(squares), sigma_m_s, five_errors);
  }
}

TEST(StepMotion, LeavesEachParticleTheWindThatItHas) {
  VehicleNoise vehicle;
  vehicle.wind = {3.0};
  StepMotion motion(vehicle, kFlight, {Odometry{20.0, 0.0, {}}, {}, 1.0}, kFlewAt20MS);
  FilterOptions options = FilterOptions::paper(1'000);
  options.injected_share = 0.0;
  Filter filter(options, motion.region(), 1);
  filter.start_uniformly(kFlight.poses);
  const Particles before = filter.particles();
  motion.move(filter);
  double squares = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    squares += std::pow(filter.particles().drift_east_m_s[i] - before.drift_east_m_s[i], 2.0) / 1'000.0;
  }
  EXPECT_NEAR(std::sqrt(squares), 3.0 / std::sqrt(40.0 * 60.0), 0.01) << "it changes by its size in 40 minutes";
}

TEST(StepMotion, FollowsOdometryAloneOnceItIsToldAgain) {
  const auto [before, learned] = coasted(20.0);
  const VehicleNoise vehicle;
  StepMotion motion(vehicle, kFlight, {Odometry{33.0, 0.0, {}}, OdometryCovariance{}, 1.5}, learned);
  FilterOptions options = FilterOptions::paper(5'000);
  options.injected_share = 0.0;
  Filter filter(options, motion.region(), before);
  motion.move(filter);
  const Particles& p = filter.particles();
  for (std::size_t i = 0; i < p.size(); ++i) {
    ASSERT_NEAR(p.east_m[i] - before.particles.east_m[i], 33.0 * std::sin(p.heading_rad[i]), 1e-9);
    ASSERT_NEAR(p.north_m[i] - before.particles.north_m[i], 33.0 * std::cos(p.heading_rad[i]), 1e-9);
    ASSERT_EQ(p.drift_east_m_s[i], 0.0) << "there is no wind";
  }
  EXPECT_EQ(motion.learned().coasted_s, 0.0);
}

/// 1 sigma of the way, m, and of the turn, rad, after 20 s by a speed and a turn rate known to 1 m/s and 0.01 rad/s.
std::pair<double, double> spread_by_told_speed(int steps, bool sees) {
  VehicleNoise vehicle;
  vehicle.planar = VehicleNoise::Planar{{0.0, 1.0}, {0.0, 0.01}};  // the mean goes nowhere: headings don't bend the way
  LearnedMotion learned;
  FilterOptions options = FilterOptions::paper(5'000);
  options.injected_share = 0.0;
  Filter filter(options, kFlight, 1);
  filter.start_anew_from(std::vector<Proposal>{{{{500.0, 500.0}, Angle()}}}, 0.0, kFlight.poses);
  for (int k = 0; k < steps; ++k) {
    StepMotion motion(vehicle, kFlight, {{}, {}, 20.0 / steps}, learned);
    motion.move(filter);
    if (sees) motion.see();
    learned = motion.learned();
  }
  const Particles& p = filter.particles();
  double metres2 = 0.0;
  double turn2 = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    metres2 += (std::pow(p.east_m[i] - 500.0, 2.0) + std::pow(p.north_m[i] - 500.0, 2.0)) / 5e3;
    turn2 += p.heading_rad[i] * p.heading_rad[i] / 5e3;
  }
  return {std::sqrt(metres2), std::sqrt(turn2)};
}

TEST(StepMotion, AddsUpTheErrorsOfAToldSpeedAndTurnRateUntilAFrameComes) {
  const double five_errors = 5.0 / std::sqrt(2.0 * 5e3);
  for (const int steps : {1, 4, 100}) {
    const auto [metres, turn] = spread_by_told_speed(steps, false);
    EXPECT_NEAR(metres, 20.0, five_errors * 20.0) << steps;
    EXPECT_NEAR(turn, 0.2, five_errors * 0.2) << steps;
    const auto [seen_metres, seen_turn] = spread_by_told_speed(steps, true);
    EXPECT_NEAR(seen_metres, 20.0 / std::sqrt(steps), five_errors * 20.0 / std::sqrt(steps)) << steps;
    EXPECT_NEAR(seen_turn, 0.2 / std::sqrt(steps), five_errors * 0.2 / std::sqrt(steps)) << steps;
  }
}

/// By how much particles turn, mean and deviation, when a vehicle that turned so fast tells no motion any more.
std::pair<double, double> turned_by_deg(double seconds, int steps, double turn_deg_s) {
  const VehicleNoise vehicle;
  StepMotion told(vehicle, kFlight, {Odometry{12.0, 0.0, Angle::degrees(turn_deg_s)}, OdometryCovariance{}, 1.0}, {});
  Filter filter = filter_at(told, {{500.0, 500.0}, Angle()});
  told.move(filter);
  const std::vector<double> before = filter.particles().heading_rad;
  LearnedMotion learned = told.learned();
  FilterOptions options = FilterOptions::paper(100);
  options.injected_share = 0.0;
  FilterState state = filter.state();
  for (int k = 0; k < steps; ++k) {
    StepMotion coasting(vehicle, kFlight, {{}, {}, seconds / steps}, learned);
    Filter coasted(options, coasting.region(), std::move(state));
    EXPECT_EQ(coasting.move(coasted), 1.0);
    state = coasted.state();
    learned = coasting.learned();
  }
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double turned = Angle::radians(state.particles.heading_rad[i] - before[i]).wrapped().degrees();
    sum += turned;
    squares += turned * turned;
  }
  const double n = static_cast<double>(before.size());
  return {sum / n, std::sqrt(squares / n - sum * sum / n / n)};
}

TEST(StepMotion, GoesOnTurningForSomeSecondsAndDoubtsIt) {
  for (const int steps : {1, 4}) {
    // 12 degrees/s for 3 s: 36 degrees if it goes on and none if it stopped. Expected 22.8, doubted by half, and 5.0 by
    // the wandering: 12.4. Five sigma of 100 draws.
    const auto [mean, sigma] = turned_by_deg(3.0, steps, 12.0);
    EXPECT_NEAR(mean, 36.0 * (1.0 - std::exp(-1.0)), 5.0 * 12.4 / 10.0) << steps;
    EXPECT_NEAR(sigma, 12.4, 5.0 * 12.4 / std::sqrt(200.0)) << steps;
  }
  // After long 36 degrees in all, doubted by half, and 9.1 by the wandering of 10 s: 19.6.
  EXPECT_NEAR(turned_by_deg(10.0, 1, 12.0).first, 36.0 * (1.0 - std::exp(-10.0 / 3.0)), 5.0 * 19.6 / 10.0);
  const auto [straight_on, sigma] = turned_by_deg(3.0, 1, 0.0);
  EXPECT_NEAR(straight_on, 0.0, 5.0 * 5.0 / 10.0);
  EXPECT_LT(sigma, 8.0);
}

TEST(StepMotion, KeepsTheCourseOfAVehicleThatYawedAsItFlewStraightOn) {
  const VehicleNoise vehicle;
  StepMotion told(vehicle, kFlight, {Odometry{12.0, 0.0, Angle::degrees(40.0)}, OdometryCovariance{}, 1.0}, {});
  Filter filter = filter_at(told, {{500.0, 500.0}, Angle()});
  told.move(filter);
  ASSERT_TRUE(told.learned().velocity);
  // The heading is 40 degrees to the right of the course now.
  EXPECT_NEAR(told.learned().velocity->forward_m_s, 12.0 * std::cos(Angle::degrees(40.0).radians()), 1e-9);
  EXPECT_NEAR(told.learned().velocity->right_m_s, -12.0 * std::sin(Angle::degrees(40.0).radians()), 1e-9);
}

TEST(StepMotion, LearnsADriftOnlyOfOdometry) {
  const VehicleNoise vehicle;
  StepMotion flown(vehicle, kFlight, {Odometry{20.0, 0.0, {}}, {}, 1.0}, kFlewAt20MS);
  Filter filter = filter_at(flown, {{500.0, 500.0}, Angle()});
  EXPECT_TRUE(flown.odometry_is_complete());
  flown.learn_drift(filter);
  EXPECT_TRUE(flown.learned().odometry_is_wrong);
  EXPECT_EQ(flown.region().drift_sigma_m_s, 6.0) << "three tenths of the speed";
  EXPECT_FALSE(flown.odometry_is_complete());

  StepMotion coasting(vehicle, kFlight, {{}, {}, 1.0}, kFlewAt20MS);
  const Particles before = filter.particles();
  coasting.learn_drift(filter);
  coasting.try_drifts(filter);
  EXPECT_FALSE(coasting.learned().odometry_is_wrong);
  EXPECT_TRUE(filter.particles() == before);
}

/// Of their drift to the east, about 0.
double drift_sigma_m_s(const Filter& filter) {
  double squares = 0.0;
  for (const double drift : filter.particles().drift_east_m_s) squares += drift * drift;
  return std::sqrt(squares / static_cast<double>(filter.particles().size()));
}

TEST(StepMotion, SpreadsTheDriftOnceByWhatItLearnsThatOdometryMayBeWrongBy) {
  for (const auto& [speed_m_s, told_m_s, sigma_m_s] :
       {std::array{20.0, 0.0, 6.0}, {10.0, 0.0, 5.0}, {10.0, 8.0, 8.0}}) {
    VehicleNoise vehicle;
    vehicle.wind = {told_m_s};
    StepMotion flown(vehicle, kFlight, {Odometry{speed_m_s, 0.0, {}}, {}, 1.0}, {BodyVelocity{speed_m_s, 0.0}});
    Filter filter(FilterOptions::paper(5'000), kFlight, 1);
    filter.start_uniformly(kFlight.poses);
    flown.learn_drift(filter);
    EXPECT_NEAR(drift_sigma_m_s(filter), sigma_m_s, 5.0 * sigma_m_s / std::sqrt(10'000.0)) << speed_m_s;
    const Particles once = filter.particles();
    flown.learn_drift(filter);
    EXPECT_TRUE(filter.particles() == once);
    flown.begin_anew();
    EXPECT_TRUE(flown.learned().odometry_is_wrong) << "whatever the belief";
    EXPECT_FALSE(flown.learned().velocity);
  }
}

TEST(StepMotion, TriesOtherDriftsWithATenthOfItsParticlesUnlessAWindIsLearnedAnyway) {
  for (const double wind_m_s : {0.0, 3.0}) {
    VehicleNoise vehicle;
    vehicle.wind = {wind_m_s};
    const StepMotion motion(vehicle, kFlight, {Odometry{20.0, 0.0, {}}, {}, 1.0}, kFlewAt20MS);
    Filter filter(FilterOptions::paper(5'000), kFlight, 1);
    filter.start_uniformly(kFlight.poses);
    motion.try_drifts(filter);
    const auto tried = 5'000 - std::ranges::count(filter.particles().drift_east_m_s, 0.0);
    EXPECT_NEAR(static_cast<double>(tried), wind_m_s > 0.0 ? 0.0 : 500.0, 5.0 * std::sqrt(450.0));
    EXPECT_NEAR(drift_sigma_m_s(filter), wind_m_s > 0.0 ? 0.0 : std::sqrt(0.1) * 6.0, 0.3);
  }
}

TEST(StepMotion, LetsTheErrorOfAnAltitudeWanderWithinItsRangeByThreePercentOfThatInASecond) {
  VehicleNoise vehicle;
  vehicle.scale_range = 0.1;
  AcceptanceRegion flight = kFlight;
  flight.max_log_scale = 0.1;
  StepMotion motion(vehicle, flight, {Odometry{20.0, 0.0, {}}, {}, 4.0}, kFlewAt20MS);
  FilterOptions options = FilterOptions::paper(5'000);
  options.injected_share = 0.0;
  Filter filter(options, flight, 1);
  filter.start_anew_from(std::vector<Proposal>{{{{500.0, 500.0}, Angle()}}}, 0.0, flight.poses);
  motion.move(filter);
  double squares = 0.0;
  for (const double log_scale : filter.particles().log_scale) squares += log_scale * log_scale / 5'000.0;
  EXPECT_NEAR(std::sqrt(squares), 0.03 * 0.1 * std::sqrt(4.0), 5.0 * 0.006 / std::sqrt(10'000.0));
}

TEST(StepMotion, TellsTheWayOfAStep) {
  const VehicleNoise vehicle;
  const auto travelled_m = [&](const ToldMotion& told) {
    return StepMotion(vehicle, kFlight, told, kFlewAt20MS).travelled_m();
  };
  EXPECT_DOUBLE_EQ(travelled_m({Odometry{3.0, -4.0, {}}, {}, 1.0}), 5.0);
  EXPECT_DOUBLE_EQ(travelled_m({Odometry{3.0, -4.0, {}}, {}, 1.0, 2}), 15.0) << "two steps of the same kind were lost";
  EXPECT_DOUBLE_EQ(travelled_m({{}, {}, 2.5}), 50.0) << "on as it flew";
}

}  // namespace
}  // namespace roadfix
