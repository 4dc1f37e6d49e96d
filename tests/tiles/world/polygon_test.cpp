#include "tiles/world/polygon.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <opencv2/imgproc.hpp>

namespace roadfix::world {
namespace {

using ::testing::DoubleNear;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Polyline kField{{0, 0}, {40, 0}, {40, 20}, {0, 20}};

TEST(Polygon, KnowsItsMeasures) {
  EXPECT_EQ(area_of(kField), 800.0);
  EXPECT_EQ(middle_of(kField), PlanPoint(20, 10));
  EXPECT_EQ(box_of(kField), cv::Rect2d(0, 0, 40, 20));
  EXPECT_EQ(longest_side(kField), PlanPoint(1, 0));
  EXPECT_EQ(extent_along(kField, {0, 1}), 20.0);
}

TEST(Polygon, IsCutIntoPartsThatMakeUpTheWhole) {
  const Cut halves = cut(kField, {10, 10}, PlanPoint(1, 2) / std::sqrt(5.0));
  ASSERT_THAT(halves.chord, SizeIs(2));
  EXPECT_NEAR(area_of(halves.parts[0]) + area_of(halves.parts[1]), 800.0, 1e-9);
  EXPECT_NEAR(std::min(area_of(halves.parts[0]), area_of(halves.parts[1])), 200.0, 1e-9);
}

TEST(Polygon, IsCrossedInPiecesWhereItIsHollow) {
  const Polyline horseshoe{{0, 0}, {30, 0}, {30, 20}, {20, 20}, {20, 10}, {10, 10}, {10, 20}, {0, 20}};
  const auto low = stretches(horseshoe, {-5, 5}, {1, 0});
  ASSERT_THAT(low, SizeIs(1));
  EXPECT_EQ(low[0].first, PlanPoint(0, 5));
  EXPECT_EQ(low[0].second, PlanPoint(30, 5));
  const auto high = stretches(horseshoe, {-5, 15}, {1, 0});
  ASSERT_THAT(high, SizeIs(2));
  EXPECT_EQ(high[0].second, PlanPoint(10, 15));
  EXPECT_EQ(high[1].first, PlanPoint(20, 15));
  EXPECT_THAT(stretches(horseshoe, {0, 25}, {1, 0}), IsEmpty());
}

TEST(Polygon, OfARoundShapeLiesAroundItsCentre) {
  Random random(1, 1);
  for (int i = 0; i < 20; ++i) {
    const Polyline rim = blob({100, 50}, 10.0, random);
    for (const PlanPoint& p : rim) EXPECT_THAT(cv::norm(p - PlanPoint(100, 50)), DoubleNear(10.0, 5.0));
  }
}

}  // namespace
}  // namespace roadfix::world
