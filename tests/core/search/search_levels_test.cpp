#include "core/search/search_levels.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <utility>

#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

/// Of a frame of `side_m`, asked over a square of `region_m` and sizes: the cells of each level, and how many are
/// followed from it.
std::map<double, std::size_t> levels_of(double side_m, double region_m, double scale_range = 0.0) {
  const RoadGrid map = testing::street_map(1, {2.0, {100'000, -1'000'000}, 200, 200});
  const int cells = static_cast<int>(side_m / 2.0);
  const FeatureMap features = FeatureMap::centred(CellArray(cells, cells, kNoRoad), 2.0);
  PoseRegion region;
  region.box = {{200'000.0, 2'000'000.0}, {200'000.0 + region_m, 2'000'000.0 + region_m}};
  SearchOptions options;
  options.scale_range = scale_range;
  const SearchLevels levels(testing::reader_of(map), 2.0, features, region, options);
  std::map<double, std::size_t> result;
  for (int k = 0; k <= levels.coarsest(); ++k) result[levels.at(k).cell_m()] = levels.candidates_followed(k);
  return result;
}

std::size_t followed(double side_m, double region_m, double cell_m) { return levels_of(side_m, region_m).at(cell_m); }

/// The finest and the coarsest cells.
std::pair<double, double> cells_of(double side_m, double region_m, double scale_range = 0.0) {
  const auto levels = levels_of(side_m, region_m, scale_range);
  return {levels.begin()->first, levels.rbegin()->first};
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
  EXPECT_EQ(followed(600, 4'000, 16.0), 2048U);
  EXPECT_EQ(followed(600, 4'000, 8.0), 512U);
}

TEST(SearchLevels, AreAsFineAndAsCoarseAsTheFootprintNeeds) {
  EXPECT_EQ(cells_of(150, 2'000), std::pair(2.0, 4.0));
  EXPECT_EQ(cells_of(400, 2'000), std::pair(2.0, 8.0));
  EXPECT_EQ(cells_of(400, 20'000), std::pair(2.0, 16.0));
  EXPECT_EQ(cells_of(600, 2'000), std::pair(2.0, 16.0));
  EXPECT_EQ(cells_of(1'400, 2'000), std::pair(4.0, 16.0));
  EXPECT_EQ(cells_of(1'600, 2'000), std::pair(4.0, 32.0));
  EXPECT_EQ(cells_of(4'000, 2'000), std::pair(8.0, 32.0));
}

TEST(SearchLevels, AreAsCoarseForManySizesOfTheGroundAsForMuchGround) {
  EXPECT_EQ(cells_of(400, 2'000, 0.15), std::pair(2.0, 16.0));
  EXPECT_EQ(cells_of(400, 1'000, 0.15), std::pair(2.0, 8.0));
  EXPECT_EQ(cells_of(300, 2'000, 0.15), std::pair(2.0, 8.0)) << "a small frame is blurred too much";
}

TEST(SearchLevels, FollowFewerOfFootprintsThatTellPlacesApartMoreSurely) {
  EXPECT_EQ(followed(1'200, 20'000, 16.0), 4096U);
  EXPECT_EQ(followed(3'000, 20'000, 32.0), 1024U);
  EXPECT_EQ(followed(3'000, 20'000, 16.0), 256U);
  EXPECT_EQ(followed(3'000, 20'000, 8.0), 96U);
}

// The cells of a path are few, however long it is, and its roads as narrow as others.
TEST(SearchLevels, AreAsFineAsThoseOfSmallFootprintsWhereLittleOfALargeOneWasSeen) {
  const RoadGrid map = testing::street_map(1, {2.0, {100'000, -1'000'000}, 200, 200});
  FeatureMap strip = FeatureMap::centred(CellArray(2000, 2000), 2.0);
  for (int row = 0; row < 100; ++row) {
    for (int col = 0; col < 2000; ++col) strip.cells.at(col, row) = kNoRoad;
  }
  const SearchLevels levels(testing::reader_of(map), 2.0, strip, PoseRegion{}, {});
  EXPECT_EQ(levels.finest().cell_m(), 2.0);
  EXPECT_EQ(levels.coarse().cell_m(), 16.0);
}

}  // namespace
}  // namespace roadfix
