#include "core/units/angle.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(Angle, WrapsIntoHalfOpenTurn) {
  EXPECT_NEAR(Angle::degrees(190).wrapped().degrees(), -170, 1e-12);
  EXPECT_NEAR(Angle::degrees(-180).wrapped().degrees(), 180, 1e-12);
  EXPECT_NEAR(Angle::degrees(720).wrapped().degrees(), 0, 1e-12);
}

TEST(Angle, CompassDegreesStayBelow360) {
  EXPECT_NEAR(Angle::degrees(-90).compass_degrees(), 270, 1e-12);
  EXPECT_EQ(Angle::degrees(360).compass_degrees(), 0);
  EXPECT_LT(Angle::degrees(-1e-20).compass_degrees(), 360);
}

TEST(Angle, DistanceCrossesNorthTheShortWay) {
  EXPECT_NEAR(angular_distance(Angle::degrees(350), Angle::degrees(10)).degrees(), 20, 1e-12);
  EXPECT_NEAR(angular_distance(Angle::degrees(90), Angle::degrees(-90)).degrees(), 180, 1e-12);
}

}  // namespace
}  // namespace roadfix
