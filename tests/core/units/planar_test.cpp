#include "core/units/planar.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

constexpr GridBox kBox{{10.0, 20.0}, {30.0, 50.0}};

TEST(GridBox, OverlapsWhatSharesMoreThanItsRim) {
  EXPECT_TRUE(kBox.overlaps(kBox));
  EXPECT_TRUE(kBox.overlaps({{29.0, 0.0}, {99.0, 21.0}}));
  EXPECT_TRUE(kBox.overlaps({{15.0, 30.0}, {16.0, 31.0}})) << "one inside";
  EXPECT_TRUE(kBox.overlaps({{0.0, 30.0}, {99.0, 31.0}})) << "one across";
  EXPECT_FALSE(kBox.overlaps({{30.0, 20.0}, {40.0, 50.0}})) << "beside each other";
  EXPECT_FALSE(kBox.overlaps({{10.0, 50.0}, {30.0, 60.0}})) << "above each other";
  EXPECT_FALSE(kBox.overlaps({{31.0, 51.0}, {40.0, 60.0}})) << "apart";
}

TEST(GridBox, UnitedHoldsBoth) {
  const GridBox both = united(kBox, {{0.0, 30.0}, {15.0, 99.0}});
  EXPECT_EQ(both.min, (GridPoint{0.0, 20.0}));
  EXPECT_EQ(both.max, (GridPoint{30.0, 99.0}));
}

TEST(GridBox, UnitedOfManyLeavesOutTheEmptyOne) {
  const std::array<GridBox, 3> boxes{kEmptyBox, kBox, {{0.0, 30.0}, {15.0, 99.0}}};
  EXPECT_EQ(united(boxes).min, (GridPoint{0.0, 20.0}));
  EXPECT_EQ(united(boxes).max, (GridPoint{30.0, 99.0}));
  EXPECT_TRUE(united(std::span<const GridBox>()).empty());
}

TEST(GridBox, AroundPointsTouchesTheOutermost) {
  const std::array<GridPoint, 3> points{{{1.0, 5.0}, {-2.0, 3.0}, {0.0, 4.0}}};
  EXPECT_EQ(box_around(points).min, (GridPoint{-2.0, 3.0}));
  EXPECT_EQ(box_around(points).max, (GridPoint{1.0, 5.0}));
  EXPECT_TRUE(box_around({}).empty());
}

TEST(GridBox, IntersectionIsWhatBothHold) {
  const GridBox shared = intersection(kBox, {{0.0, 30.0}, {15.0, 99.0}});
  EXPECT_EQ(shared.min, (GridPoint{10.0, 30.0}));
  EXPECT_EQ(shared.max, (GridPoint{15.0, 50.0}));
  EXPECT_TRUE(intersection(kBox, {{31.0, 20.0}, {40.0, 50.0}}).empty());
}

TEST(GridBox, GrowsOnEachSide) {
  EXPECT_EQ(grown(kBox, 5.0).min, (GridPoint{5.0, 15.0}));
  EXPECT_EQ(grown(kBox, 5.0).max, (GridPoint{35.0, 55.0}));
}

TEST(GridBox, ItsNearestPointIsThePointItselfInsideAndOnTheRimOutside) {
  EXPECT_EQ(nearest(kBox, {12.0, 49.0}), (GridPoint{12.0, 49.0}));
  EXPECT_EQ(nearest(kBox, {0.0, 30.0}), (GridPoint{10.0, 30.0}));
  EXPECT_EQ(nearest(kBox, {99.0, 99.0}), (GridPoint{30.0, 50.0}));
}

TEST(GridCircle, HoldsItsRim) {
  const GridCircle circle{{100.0, 200.0}, 5.0};
  EXPECT_TRUE(contains(circle, {103.0, 204.0}));
  EXPECT_FALSE(contains(circle, {103.1, 204.0}));
}

TEST(BodyOffset, GoesAheadAndToTheRightOfWhereTheBodyPoints) {
  const GridPose eastward{{100.0, 200.0}, Angle::degrees(90.0)};
  const GridPose there = moved(eastward, {30.0, 4.0, Angle::degrees(-100.0)});
  EXPECT_NEAR(there.position.east_m, 130.0, 1e-9);
  EXPECT_NEAR(there.position.north_m, 196.0, 1e-9);
  EXPECT_NEAR(there.heading.degrees(), -10.0, 1e-9);
}

TEST(BodyOffset, IsAsLongAsTheWayBetweenThePoses) {
  EXPECT_EQ(distance_m(BodyOffset{-3.0, 4.0, Angle::degrees(90.0)}), 5.0);
}

TEST(BodyOffset, IsFoundAgainBetweenTheTwoPoses) {
  const GridPose from{{600'000.0, 6'400'000.0}, Angle::degrees(-160.0)};
  const BodyOffset offset{-120.0, 4.0, Angle::degrees(-35.0)};
  const GridPose to = moved(from, offset);
  EXPECT_NEAR(to.heading.degrees(), 165.0, 1e-9);
  const BodyOffset found = offset_from(from, to);
  EXPECT_NEAR(found.forward_m, offset.forward_m, 1e-8);
  EXPECT_NEAR(found.right_m, offset.right_m, 1e-8);
  EXPECT_NEAR(found.turn.degrees(), offset.turn.degrees(), 1e-9);
}

}  // namespace
}  // namespace roadfix
