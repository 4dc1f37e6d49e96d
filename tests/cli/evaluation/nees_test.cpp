#include "cli/evaluation/nees.hpp"

#include <gtest/gtest.h>

namespace roadfix::evaluation {
namespace {

TEST(Nees, CountsTheErrorAlongAndAcrossTheEllipseInItsSigmas) {
  const GridPoint centre{100.0, 200.0};
  const Ellipse to_the_east{{10.0, 2.0}, Angle::degrees(90.0)};
  EXPECT_NEAR(nees(centre, to_the_east, {130.0, 200.0}), 9.0, 1e-9);
  EXPECT_NEAR(nees(centre, to_the_east, {100.0, 196.0}), 4.0, 1e-9);
  EXPECT_NEAR(nees(centre, to_the_east, {120.0, 206.0}), 4.0 + 9.0, 1e-9);
  const Ellipse north_east{{10.0, 1.0}, Angle::degrees(45.0)};
  EXPECT_NEAR(nees({}, north_east, {10.0, 10.0}), 2.0, 1e-9);
  EXPECT_NEAR(nees({}, north_east, {-1.0, 1.0}), 2.0, 1e-9);
}

TEST(Nees, OfAnEllipseWithoutAnAreaIsFinite) {
  EXPECT_EQ(nees({}, {}, {0.0, 0.0}), 0.0);
  EXPECT_NEAR(nees({}, {}, {0.0, 1.0}), 1e6, 1e-3);
}

TEST(Nees, OfAHeadingCountsTheShorterWayRound) {
  const Angle sigma = Angle::degrees(2.0);
  EXPECT_NEAR(heading_nees(Angle::degrees(359.0), sigma, Angle::degrees(3.0)), 4.0, 1e-9);
  EXPECT_NEAR(heading_nees(Angle::degrees(3.0), sigma, Angle::degrees(359.0)), 4.0, 1e-9);
}

}  // namespace
}  // namespace roadfix::evaluation
