#include "core/locate/same_view.hpp"

#include <gtest/gtest.h>

#include <string_view>

#include "tests/support/ascii_map.hpp"

namespace roadfix {
namespace {

FeatureMap seen(std::string_view picture) { return FeatureMap::centred(testing::from_ascii(picture), 2.0); }

const FeatureMap kRoadAcross = seen("...\n###\n...");

TEST(SameView, IsOneOfTheSameRoadsInCellsOfTheSameSize) {
  EXPECT_TRUE(is_same_view(kRoadAcross, kRoadAcross));
  EXPECT_FALSE(is_same_view(kRoadAcross, seen("###\n...\n...")));
  FeatureMap larger = kRoadAcross;
  larger.cell_m = 3.0;
  EXPECT_FALSE(is_same_view(kRoadAcross, larger));
}

TEST(SameView, IsNoneOfTwoWoods) {
  const FeatureMap wood = seen("...\n...\n...");
  EXPECT_FALSE(is_same_view(wood, wood));
}

TEST(SameView, NeedsAMoveOfAMetreOrATurnOfHalfADegreeToBeWrong) {
  EXPECT_FALSE(has_moved(0.9, Angle::degrees(0.5).radians()));
  EXPECT_TRUE(has_moved(1.1, 0.0));
  EXPECT_TRUE(has_moved(0.0, Angle::degrees(0.6).radians()));
}

}  // namespace
}  // namespace roadfix
