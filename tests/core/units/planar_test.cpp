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

TEST(GridBox, GrowsOnEachSide) {
  EXPECT_EQ(grown(kBox, 5.0).min, (GridPoint{5.0, 15.0}));
  EXPECT_EQ(grown(kBox, 5.0).max, (GridPoint{35.0, 55.0}));
}

TEST(GridBox, ItsNearestPointIsThePointItselfInsideAndOnTheRimOutside) {
  EXPECT_EQ(nearest(kBox, {12.0, 49.0}), (GridPoint{12.0, 49.0}));
  EXPECT_EQ(nearest(kBox, {0.0, 30.0}), (GridPoint{10.0, 30.0}));
  EXPECT_EQ(nearest(kBox, {99.0, 99.0}), (GridPoint{30.0, 50.0}));
}

}  // namespace
}  // namespace roadfix
