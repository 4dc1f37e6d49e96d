#include "core/units/grid_quad.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace roadfix {
namespace {

GridSide straight(double at_m, double slope = 0.0) {
  return GridSide({{{0.0, at_m}, {50.0, at_m + 50.0 * slope}, {100.0, at_m + 100.0 * slope}}});
}

TEST(GridSide, IsTheParabolaThroughItsPoints) {
  const GridSide side({{{10.0, 3.0}, {20.0, 1.0}, {40.0, 9.0}}});
  EXPECT_DOUBLE_EQ(side.at_m(10.0), 3.0);
  EXPECT_DOUBLE_EQ(side.at_m(20.0), 1.0);
  EXPECT_DOUBLE_EQ(side.at_m(40.0), 9.0);
  EXPECT_DOUBLE_EQ(side.highest_m(10.0, 40.0), 9.0);
  double lowest_m = 9.0;
  for (int i = 0; i <= 3000; ++i) lowest_m = std::min(lowest_m, side.at_m(10.0 + 0.01 * i));
  EXPECT_NEAR(side.lowest_m(10.0, 40.0), lowest_m, 1e-4) << "between the points";
  EXPECT_DOUBLE_EQ(side.lowest_m(30.0, 40.0), side.at_m(30.0));
}

TEST(GridSide, OfNoLengthIsStraight) {
  const GridSide side({{{10.0, 3.0}, {10.0, 3.0}, {10.0, 3.0}}});
  EXPECT_DOUBLE_EQ(side.at_m(20.0), 3.0);
}

TEST(GridQuad, GrowsByMetresAcrossItsSides) {
  const GridQuad quad{straight(0.0, 1.0), straight(50.0, 1.0), straight(0.0), straight(100.0)};
  const GridPoint beyond{50.0 - 7.0, 50.0};  // 4.95 m from the western side
  EXPECT_FALSE(quad.contains(beyond));
  EXPECT_FALSE(quad.grown(4.9).contains(beyond));
  EXPECT_TRUE(quad.grown(5.0).contains(beyond));
}

TEST(GridQuad, ReachesIntoTheBoxOfWhatBothHold) {
  const GridQuad quad{straight(0.0, 0.1), straight(5.0, 0.1), straight(0.0), straight(100.0)};
  const GridBox low = quad.within({{-50.0, -20.0}, {50.0, 20.0}});
  EXPECT_NEAR(low.min.east_m, 0.0, 1e-9);
  EXPECT_NEAR(low.max.east_m, 7.0, 1e-9) << "where its eastern side leaves the box";
  EXPECT_NEAR(low.min.north_m, 0.0, 1e-9);
  EXPECT_NEAR(low.max.north_m, 20.0, 1e-9);
  EXPECT_TRUE(quad.within({{10.0, 0.0}, {50.0, 20.0}}).empty()) << "in the box around the quad, but beside it";
  EXPECT_FALSE(quad.within({{10.0, 60.0}, {50.0, 80.0}}).empty());
}

}  // namespace
}  // namespace roadfix
