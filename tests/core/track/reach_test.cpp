#include "core/track/reach.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/units/draws.hpp"

namespace roadfix {
namespace {

constexpr OdometryCovariance covariance(double sigma_m, double turn_rad) {
  return {{{sigma_m * sigma_m, 0, 0}, {0, sigma_m * sigma_m, 0}, {0, 0, turn_rad * turn_rad}}};
}

Reach known_start(double radius_m, double heading_half_width_deg) {
  return {{1000.0, 2000.0}, Angle::degrees(30.0), radius_m, Angle::degrees(heading_half_width_deg)};
}

TEST(Reach, IsTheCircleAndTheHeadingsOfARegion) {
  const PoseRegion region{
      {{0.0, 0.0}, {500.0, 500.0}}, GridCircle{{480.0, 250.0}, 60.0}, Angle::degrees(20.0), Angle::degrees(15.0)};
  const Reach reach = Reach::within(region);
  EXPECT_EQ(reach.position, (GridPoint{480.0, 250.0})) << "where the map ends the circle does not";
  EXPECT_EQ(reach.radius_m, 60.0);
  EXPECT_EQ(reach.heading, Angle::degrees(20.0));
  EXPECT_NEAR(reach.turned_at_most().degrees(), 15.0, 1e-9);
}

TEST(Reach, HoldsAVehicleAsLongAsOdometryErrsByNoMoreThanItSays) {
  std::mt19937_64 random(7);
  for (int flight = 0; flight < 300; ++flight) {
    Reach reach = known_start(50.0, flight % 2 == 0 ? 15.0 : 180.0);
    const double off_m = uniform(random, 0.0, 50.0);
    const Angle off = Angle::degrees(uniform(random, -180.0, 180.0));
    const double half_deg = reach.heading_half_width.degrees();
    GridPose vehicle{{1000.0 + off_m * sin(off), 2000.0 + off_m * cos(off)},
                     reach.heading + Angle::degrees(uniform(random, -half_deg, half_deg))};
    const double along = uniform(random, -2.0, 2.0);  // standard deviations, the same in all steps
    for (int step = 0; step < 40; ++step) {
      const Odometry told{uniform(random, 0.0, 25.0), uniform(random, -3.0, 3.0),
                          Angle::degrees(uniform(random, -9, 9))};
      const double turn_error = 0.01 * uniform(random, -std::sqrt(3.0), std::sqrt(3.0));  // of 0.01 rad, 1 sigma
      vehicle = moved(vehicle, {told.forward_m + along, told.right_m, told.turn + Angle::radians(turn_error)});
      reach.move(told, covariance(1.0, 0.01), 0.0);
      EXPECT_LE(distance_m(vehicle.position, reach.position), reach.radius_m + 1e-6) << flight << ", step " << step;
      EXPECT_LE(angular_distance(vehicle.heading, reach.heading), reach.turned_at_most())
          << flight << ", step " << step;
    }
  }
}

TEST(Reach, StaysWhereItIsAndGrowsByTheWayWhereNoHeadingIsKnown) {
  Reach reach = known_start(50.0, 180.0);
  reach.move({20.0, 0.0, Angle::degrees(5.0)}, covariance(1.0, 0.01), 0.0);
  EXPECT_EQ(reach.position, (GridPoint{1000.0, 2000.0}));
  EXPECT_NEAR(reach.radius_m, 50.0 + 20.0 + 2.0, 1e-9);
}

TEST(Reach, GrowsByTheLongerAxisOfTheErrorWhateverItsDirection) {
  for (const double turned_deg : {0.0, 30.0, 45.0, 90.0}) {
    const double s = sin(Angle::degrees(turned_deg));
    const double c = cos(Angle::degrees(turned_deg));
    const OdometryCovariance thin{{{9.0 * c * c, 9.0 * s * c, 0}, {9.0 * s * c, 9.0 * s * s, 0}, {0, 0, 0}}};
    Reach reach = known_start(50.0, 0.0);
    reach.move({20.0, 0.0, {}}, thin, 0.0);
    EXPECT_NEAR(reach.radius_m, 50.0 + 2.0 * 3.0, 1e-9) << turned_deg;
  }
}

TEST(Reach, MovesWithAKnownHeadingAndGrowsByLittle) {
  Reach reach = known_start(50.0, 6.0);
  reach.move({20.0, 0.0, Angle::degrees(5.0)}, covariance(1.0, 0.01), 3.0);
  EXPECT_GT(distance_m(reach.position, {1000.0, 2000.0}), 19.9);
  EXPECT_NEAR(reach.heading.degrees(), 35.0, 1e-9);
  EXPECT_NEAR(reach.radius_m, 50.0 + 40.0 * std::sin(Angle::degrees(3.0).radians()) + 2.0 + 3.0, 1e-9);
}

TEST(Reach, KnowsNoHeadingAnyMoreOnceTheMotionIsNotTold) {
  Reach reach = known_start(30.0, 6.0);
  reach.stray(45.0);
  EXPECT_EQ(reach.radius_m, 75.0);
  EXPECT_NEAR(reach.turned_at_most().degrees(), 180.0, 1e-9);
  EXPECT_FALSE(reach.is_lost());
  reach.stray(75.5);
  EXPECT_TRUE(reach.is_lost());
}

TEST(Reach, HoldsABeliefWithinItAndALittleBeyond) {
  const Reach reach = known_start(50.0, 15.0);
  const auto holds = [&](double east_m, double turn_deg) {
    return reach.holds({{1000.0 + east_m, 2000.0}, Angle::degrees(30.0 + turn_deg)});
  };
  EXPECT_TRUE(holds(55.0, 0.0));
  EXPECT_TRUE(holds(-55.0, 17.0));
  EXPECT_FALSE(holds(80.0, 0.0)) << "less than a block";
  EXPECT_FALSE(holds(0.0, 25.0));
  EXPECT_FALSE(holds(0.0, -25.0));
}

TEST(Reach, IsNarrowAroundAPlaceThatWasJustFound) {
  const GridPose found{{12.0, 34.0}, Angle::degrees(56.0)};
  const Reach reach = Reach::around(found);
  EXPECT_EQ(reach.position, found.position);
  EXPECT_EQ(reach.heading, found.heading);
  EXPECT_GE(reach.radius_m, 25.0) << "what counts as the same place";
  EXPECT_LT(reach.radius_m, 50.0) << "half a block";
}

}  // namespace
}  // namespace roadfix
