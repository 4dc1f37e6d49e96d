#include <gtest/gtest.h>

#include "core/grid/resample.hpp"
#include "core/search/search.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

class SearchSurroundings : public ::testing::Test {
 protected:
  const RoadGrid map_ = testing::street_map(15, {2.0, {150'000, -2'000'000}, 1200, 1200});
  std::mt19937_64 random_{16};
  const GridPose truth_ = testing::pose_within(map_.geometry.box(), 900.0, random_);
  const FeatureMap window_ = cut_out(map_, truth_, 128, 128, 2.0);

  /// A circle of 100 m, `east_m` beside the true place.
  PoseRegion beside(double east_m) const {
    const GridPoint centre{truth_.position.east_m + east_m, truth_.position.north_m};
    PoseRegion region = testing::all_poses_in(grown({centre, centre}, 100.0));
    region.circle = GridCircle{centre, 100.0};
    return region;
  }

  SearchResult found(const PoseRegion& region, std::optional<GridBox> surroundings) const {
    SearchOptions options;
    options.surroundings = surroundings;
    return search(testing::reader_of(map_), 2.0, window_, region, options);
  }
};

TEST_F(SearchSurroundings, TellOfABetterPlaceFarBeyondASmallRegion) {
  for (const double east_m : {-600.0, 120.0}) {
    const SearchResult result = found(beside(east_m), map_.geometry.box());
    ASSERT_FALSE(result.outside.empty());
    EXPECT_LT(distance_m(result.outside.front().pose.position, truth_.position), 1.0);
    EXPECT_GT(result.outside.front().score, result.modes.front().score);
    for (const SearchMode& mode : result.modes) EXPECT_TRUE(beside(east_m).grown(4.0, {}).contains(mode.pose.position));
  }
}

TEST_F(SearchSurroundings, HoldNoOtherPlaceThatFitsAsWellAsTheTrueOneInside) {
  const SearchResult result = found(beside(60.0), map_.geometry.box());
  EXPECT_LT(distance_m(result.modes.front().pose.position, truth_.position), 1.0);
  ASSERT_FALSE(result.outside.empty());
  EXPECT_LT(result.outside.front().score, result.modes.front().score);
  EXPECT_GT(distance_m(result.outside.front().pose.position, beside(60.0).circle->centre), 100.0);
}

TEST_F(SearchSurroundings, EndWhereTheyAreSaidTo) {
  PoseRegion region = beside(-600.0);
  const SearchResult result = found(region, grown(region.box, 50.0));
  for (const SearchMode& mode : result.outside) {
    EXPECT_TRUE(grown(region.box, 50.0).contains(mode.pose.position));
  }
  EXPECT_TRUE(found(region, std::nullopt).outside.empty());
  region.circle.reset();
  EXPECT_TRUE(found(region, region.box).outside.empty()) << "nothing lies around it";
}

TEST_F(SearchSurroundings, CountAtTheHeadingsOfTheRegionWhereNoneFitsFarBetter) {
  PoseRegion region = beside(-600.0);
  region.heading = truth_.heading + Angle::degrees(90.0);
  region.heading_half_width = Angle::degrees(20.0);
  const SearchResult result = found(region, grown(region.box, 200.0));  // without the true place
  ASSERT_FALSE(result.outside.empty());
  EXPECT_LT(angular_distance(result.outside.front().pose.heading, region.heading).degrees(), 25.0);
}

TEST_F(SearchSurroundings, TellOfAPlaceAtAnotherHeadingThatFitsFarBetter) {
  for (const double wrong_deg : {30.0, 90.0}) {
    PoseRegion region = beside(60.0);
    region.heading = truth_.heading + Angle::degrees(wrong_deg);
    region.heading_half_width = Angle::degrees(10.0);
    const SearchResult result = found(region, map_.geometry.box());
    ASSERT_FALSE(result.outside.empty());
    EXPECT_LT(distance_m(result.outside.front().pose.position, truth_.position), 1.0);
    EXPECT_LT(angular_distance(result.outside.front().pose.heading, truth_.heading).degrees(), 1.0);
  }
}

TEST_F(SearchSurroundings, TellOfChanceAsTheyDoOfALargerRegion) {
  const SearchResult small = found(beside(60.0), map_.geometry.box());
  PoseRegion whole;
  whole.box = map_.geometry.box();
  const SearchResult large = found(whole, map_.geometry.box());
  EXPECT_NEAR(small.background.sd, large.background.sd, 0.1 * large.background.sd);
  EXPECT_GE(small.background.rivals.size(), large.background.rivals.size());
  EXPECT_LT(small.background.region_share, 0.02);
}

/// Of a camera that leans far: from beyond the map's edge it sees ground of the map, so a strip along the edge competes
/// with the whole region.
TEST_F(SearchSurroundings, DoNotTellWhereTheTailOfChanceBeginsIfTheyAreAStrip) {
  FeatureMap leaning = window_;
  leaning.nadir.row += 192.0;
  PoseRegion whole;
  whole.box = map_.geometry.box();
  SearchOptions options;
  options.surroundings = whole.box;
  const ScoreBackground chance = search(testing::reader_of(map_), 2.0, leaning, whole, options).background;
  ASSERT_GT(chance.rivals_within.size(), 50U);
  EXPECT_GE(chance.rivals.back(), chance.rivals_within.back());
}

}  // namespace
}  // namespace roadfix
