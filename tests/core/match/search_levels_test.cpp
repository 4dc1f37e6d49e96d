#include "core/match/search_levels.hpp"

#include <gtest/gtest.h>

#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

/// Of a frame of `side_m`, asked over a square of `region_m`: how many are followed from the level of `cell_m`.
std::size_t followed(double side_m, double region_m, double cell_m) {
  const RoadGrid map = testing::street_map(1, {2.0, {100'000, -1'000'000}, 200, 200});
  const int cells = static_cast<int>(side_m / 2.0);
  const FeatureMap features = FeatureMap::centred(CellArray(cells, cells, kNoRoad), 2.0);
  PoseRegion region;
  region.box = {{200'000.0, 2'000'000.0}, {200'000.0 + region_m, 2'000'000.0 + region_m}};
  const SearchLevels levels(testing::reader_of(map), 2.0, features, region, {});
  for (int k = 0; k <= levels.coarsest(); ++k) {
    if (levels.at(k).cell_m() == cell_m) return levels.followed(k);
  }
  return 0;
}

TEST(SearchLevels, FollowAsManyCandidatesForTheGroundOfALargeRegionAsOfASmallOne) {
  EXPECT_EQ(followed(300, 2'000, 8.0), 256U);
  EXPECT_EQ(followed(300, 4'000, 8.0), 512U);
  EXPECT_EQ(followed(300, 10'000, 8.0), 3200U);
  EXPECT_EQ(followed(180, 10'000, 4.0), 3200U) << "small frames are scanned in finer cells";
  EXPECT_EQ(followed(300, 20'000, 8.0), 4096U);
}

TEST(SearchLevels, FollowFewerFromTheLevelBelowTheScan) {
  EXPECT_EQ(followed(600, 20'000, 16.0), 4096U);
  EXPECT_EQ(followed(600, 20'000, 8.0), 1024U);
  EXPECT_EQ(followed(600, 20'000, 4.0), 96U);
}

}  // namespace
}  // namespace roadfix
