#include "core/locate/ellipse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geodesy/utm.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {
namespace {

const UtmZone kZone = UtmZone::containing({37.7, 38.3});
const GridPoint kFarFromTheMeridian{180'000.0, 4'180'000.0};

MapView map_registered_to(double sigma_m) {
  return {.id = {"map", "1"},
          .zone = kZone,
          .extent = {},
          .registration_sigma_m = [sigma_m](GridPoint) { return sigma_m; },
          .read = {}};
}

/// Of a position that is `along_m` unsure in the direction `grid` and `across_m` across it.
PoseCovariance covariance_of(Angle grid, double along_m, double across_m) {
  const PositionCovariance of = position_covariance({along_m * along_m, across_m * across_m}, grid);
  return {{{of.east_east, of.east_north, 0.0}, {of.east_north, of.north_north, 0.0}, {}}};
}

TEST(Ellipse, PointsAlongTheUnsureDirectionFromTrueNorthWithinHalfATurn) {
  for (double degrees = -175.0; degrees < 180.0; degrees += 10.0) {
    const Angle grid = Angle::degrees(degrees);
    const Ellipse ellipse = ellipse_of(map_registered_to(0.0), kFarFromTheMeridian, covariance_of(grid, 9.0, 4.0));
    EXPECT_NEAR(ellipse.sigma_m[0], 9.0, 1e-9);
    EXPECT_NEAR(ellipse.sigma_m[1], 4.0, 1e-9);
    EXPECT_GE(ellipse.heading.degrees(), 0.0);
    EXPECT_LT(ellipse.heading.degrees(), 180.0);
    const Angle expected = kZone.true_from_grid(grid, kFarFromTheMeridian);
    EXPECT_NEAR(sin(ellipse.heading - expected), 0.0, 1e-9) << degrees;
  }
}

TEST(Ellipse, HasASquaredMahalanobisDistanceOfOneOnItsRim) {
  const Angle axis = Angle::degrees(30.0);
  const PositionCovariance covariance = position_covariance({9.0 * 9.0, 4.0 * 4.0}, axis);
  const auto distance2 = [&](Angle direction, double metres) {
    return squared_mahalanobis({100.0, 200.0}, {100.0 + metres * sin(direction), 200.0 + metres * cos(direction)},
                               covariance);
  };
  EXPECT_NEAR(distance2(axis, 9.0), 1.0, 1e-9);
  EXPECT_NEAR(distance2(axis + Angle::degrees(90.0), 4.0), 1.0, 1e-9);
  EXPECT_NEAR(distance2(axis, 27.0), 9.0, 1e-9);
}

TEST(Ellipse, GrowsByTheErrorOfTheMapsRegistrationOnBothAxes) {
  const auto covariance = covariance_of(Angle::degrees(30.0), 8.0, 0.0);
  const Ellipse ellipse = ellipse_of(map_registered_to(6.0), kFarFromTheMeridian, covariance);
  EXPECT_NEAR(ellipse.sigma_m[0], 10.0, 1e-9);
  EXPECT_NEAR(ellipse.sigma_m[1], 6.0, 1e-9);
}

}  // namespace
}  // namespace roadfix
