#include "tiles/world/road_truth.hpp"

#include <gmock/gmock.h>

namespace roadfix::world {
namespace {

TEST(RoadTruth, CutsLinesAtTheRimOfThePicture) {
  const auto parts = clipped({{-10, 5}, {5, 5}, {5, 30}, {8, 30}, {8, 5}, {9, 6}}, 20, 10);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0], (Polyline{{0, 5}, {5, 5}, {5, 10}}));
  EXPECT_EQ(parts[1], (Polyline{{8, 10}, {8, 5}, {9, 6}}));
}

TEST(RoadTruth, LeavesOutLinesThatPassThePictureBy) {
  EXPECT_TRUE(clipped({{-5, -5}, {-5, 50}}, 20, 10).empty());
  EXPECT_TRUE(clipped({{-4, 5}, {4, -6}}, 20, 10).empty());
}

}  // namespace
}  // namespace roadfix::world
