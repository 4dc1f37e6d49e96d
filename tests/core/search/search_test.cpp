#include "core/search/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/grid/resample.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/random_cells.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::all_poses_in;
using testing::observed_at;
using testing::pose_within;
using testing::reader_of;
using testing::street_map;

GridGeometry town(double width_m, double height_m) {
  return {2.0, {150'000, -2'000'000}, static_cast<int>(width_m / 2.0), static_cast<int>(height_m / 2.0)};
}

TEST(Search, FindsAWindowOfTheMapWithinHalfACellAndOneDegree) {
  const RoadGrid map = street_map(1, town(2000, 1600));
  std::mt19937_64 random(2);
  const GridReader read = reader_of(map);
  const PoseRegion region = all_poses_in(map.geometry.box());
  for (int round = 0; round < 2; ++round) {
    const GridPose truth = pose_within(region.box, 250.0, random);
    const FeatureMap window = cut_out(map, truth, 150, 150, 2.0);
    const SearchResult found = search(read, 2.0, window, region, {});
    ASSERT_FALSE(found.modes.empty());
    EXPECT_LT(distance_m(found.modes[0].pose.position, truth.position), 1.0);
    EXPECT_LT(angular_distance(found.modes[0].pose.heading, truth.heading).degrees(), 1.0);
    EXPECT_GT(found.modes[0].pearson, 0.9);
  }
}

TEST(Search, FindsAWindowOfALargeMapThatIsScannedInCoarserCells) {
  const RoadGrid map = street_map(12, {4.0, {75'000, -1'000'000}, 1500, 1400});
  std::mt19937_64 random(13);
  const PoseRegion region = all_poses_in(map.geometry.box());
  ASSERT_GT(region.area_km2(), 30.0);
  const GridPose truth = pose_within(region.box, 400.0, random);
  const FeatureMap seen = observed_at(map, truth, 110, 110, 4.0, {0.2, 0.2}, random);
  const SearchResult found = search(reader_of(map), 4.0, seen, region, {});
  EXPECT_EQ(found.coarse_cell_m, 16.0);
  ASSERT_FALSE(found.modes.empty());
  EXPECT_LT(distance_m(found.modes[0].pose.position, truth.position), 4.0);
}

TEST(Search, FindsAWindowOfKilometresInCoarserCells) {
  const RoadGrid map = street_map(12, {4.0, {75'000, -1'000'000}, 1500, 1400});
  std::mt19937_64 random(17);
  const PoseRegion region = all_poses_in(map.geometry.box());
  const GridPose truth = pose_within(region.box, 1500.0, random);
  const FeatureMap seen = observed_at(map, truth, 520, 520, 4.0, {0.3, 0.3}, random);
  const SearchResult found = search(reader_of(map), 4.0, seen, region, {});
  EXPECT_EQ(found.coarse_cell_m, 32.0);
  EXPECT_EQ(found.cell_m, 8.0);
  ASSERT_FALSE(found.modes.empty());
  EXPECT_LT(distance_m(found.modes[0].pose.position, truth.position), 4.0);
  EXPECT_LT(angular_distance(found.modes[0].pose.heading, truth.heading).degrees(), 0.2);
}

// The scan knows means under narrow footprints so roughly that hundreds of its scores exceed 1, and true ones do not.
TEST(Search, FindsNarrowWindows) {
  for (const std::uint64_t seed : {2U, 11U, 25U}) {
    const RoadGrid map = street_map(seed, town(900, 900));
    std::mt19937_64 random(seed);
    const PoseRegion region = all_poses_in(map.geometry.box());
    const GridPose truth = pose_within(region.box, 200.0, random);
    const SearchResult found = search(reader_of(map), 2.0, cut_out(map, truth, 120, 14, 2.0), region, {});
    ASSERT_FALSE(found.modes.empty());
    EXPECT_LT(distance_m(found.modes[0].pose.position, truth.position), 2.0) << seed;
  }
}

TEST(Search, GivesEachPeakOneMode) {
  const RoadGrid map = street_map(9, town(900, 900));
  std::mt19937_64 random(10);
  const PoseRegion region = all_poses_in(map.geometry.box());
  int pairs = 0;
  for (int round = 0; round < 6; ++round) {
    const GridPose truth = pose_within(map.geometry.box(), 150.0, random);
    const FeatureMap seen = observed_at(map, truth, 80, 80, 2.0, {0.3, 0.3}, random);
    const SearchResult found = search(reader_of(map), 2.0, seen, region, {});
    for (std::size_t i = 0; i < found.modes.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k, ++pairs) {
        EXPECT_TRUE(distance_m(found.modes[i].pose.position, found.modes[k].pose.position) > 6.0 ||
                    angular_distance(found.modes[i].pose.heading, found.modes[k].pose.heading).degrees() > 0.5)
            << "modes " << k << " and " << i << " of round " << round;
      }
    }
  }
  EXPECT_GT(pairs, 0);
}

TEST(Search, TellsOfAPeakThatIsNoDistinctPlace) {
  const RoadGrid map = street_map(9, town(900, 900));
  RoadGrid twice = map;
  for (int row = 0; row < map.cells.rows(); ++row) {
    for (int col = 14; col < map.cells.cols(); ++col) {
      twice.cells.at(col, row) = std::max(map.cells.at(col, row), map.cells.at(col - 14, row));
    }
  }
  const PoseRegion region = all_poses_in(map.geometry.box());
  const GridPose truth{region.box.centre(), Angle::degrees(30.0)};
  const FeatureMap seen = cut_out(map, truth, 160, 160, 2.0);
  const SearchResult found = search(reader_of(twice), 2.0, seen, region, {});
  ASSERT_TRUE(found.nearby);
  EXPECT_LE(found.nearby->score, found.modes[0].score);
  EXPECT_NEAR(distance_m(found.nearby->pose.position, found.modes[0].pose.position), 28.0, 3.0);
  const SearchResult once = search(reader_of(map), 2.0, seen, region, {});
  EXPECT_TRUE(!once.nearby || once.nearby->score < 0.7 * once.modes[0].score);
}

TEST(Search, FindsWhatADetectorWithErrorsSeesPartlyOffTheMap) {
  const RoadGrid map = street_map(3, town(2000, 1600));
  std::mt19937_64 random(4);
  const PoseRegion region = all_poses_in(map.geometry.box());
  // A third of the footprint lies west of the map.
  const GridPose truth{{region.box.min.east_m + 60.0, region.box.min.north_m + 800.0}, Angle::degrees(211.0)};
  const FeatureMap seen = observed_at(street_map(3, town(2000, 1600)), truth, 160, 160, 2.0, {0.15, 0.15}, random);
  FeatureMap whole = seen;  // the UAV sees ground beyond the map, too
  for (Cell& cell : whole.cells.cells()) {
    if (!is_observed(cell)) cell = kNoRoad;
  }
  const SearchResult found = search(reader_of(map), 2.0, whole, region, {});
  ASSERT_FALSE(found.modes.empty());
  EXPECT_LT(distance_m(found.modes[0].pose.position, truth.position), 2.0);
  EXPECT_LT(found.modes[0].observed_cells, 160 * 160 * 9 / 10);
}

TEST(Search, FindsAWindowWhoseSizeIsKnownRoughly) {
  const RoadGrid map = street_map(16, town(1600, 1400));
  std::mt19937_64 random(17);
  PoseRegion region = all_poses_in(map.geometry.box());
  for (const double scale : {0.88, 1.12}) {
    const GridPose truth = pose_within(region.box, 350.0, random);
    // Cells of other than 2 m, said to be of 2 m.
    FeatureMap window = cut_out(map, truth, 220, 220, 2.0 * scale);
    window.cell_m = 2.0;
    region.heading = truth.heading;
    region.heading_half_width = Angle::degrees(20.0);
    SearchOptions options;
    const SearchResult as_given = search(reader_of(map), 2.0, window, region, options);
    options.scale_range = 0.15;
    const SearchResult found = search(reader_of(map), 2.0, window, region, options);
    ASSERT_FALSE(found.modes.empty());
    EXPECT_LT(distance_m(found.modes[0].pose.position, truth.position), 2.0);
    EXPECT_NEAR(found.modes[0].scale, scale, 0.01);
    EXPECT_GT(found.modes[0].score, 0.8);
    EXPECT_LT(as_given.modes[0].score, 0.7);
    EXPECT_EQ(found.scales % 2, 1);
    EXPECT_TRUE(found.complete());
    EXPECT_GT(found.background.poses, as_given.background.poses * (found.scales - 1));
  }
}

TEST(Search, StaysWithinItsRegionAndHeadingRange) {
  const RoadGrid map = street_map(5, town(1600, 1600));
  std::mt19937_64 random(6);
  const GridPose truth = pose_within(map.geometry.box(), 300.0, random);
  const FeatureMap window = cut_out(map, truth, 128, 128, 2.0);
  PoseRegion region;
  const GridPoint centre{truth.position.east_m + 30.0, truth.position.north_m};
  region.box = {{centre.east_m - 50.0, centre.north_m - 50.0}, {centre.east_m + 50.0, centre.north_m + 50.0}};
  region.circle = GridCircle{centre, 50.0};
  region.heading = truth.heading + Angle::degrees(5.0);
  region.heading_half_width = Angle::degrees(10.0);
  const SearchResult near = search(reader_of(map), 2.0, window, region, {});
  ASSERT_FALSE(near.modes.empty());
  EXPECT_LT(distance_m(near.modes[0].pose.position, truth.position), 1.0);
  EXPECT_LT(near.background.region_share, 1.0);
  EXPECT_GT(near.background.rivals.size(), 12U);
  for (const SearchMode& mode : near.modes) {
    EXPECT_LE(distance_m(mode.pose.position, centre), 54.0);
    EXPECT_LE(angular_distance(mode.pose.heading, region.heading).degrees(), 13.0);
  }
  region.heading = truth.heading + Angle::degrees(90.0);
  const SearchResult turned = search(reader_of(map), 2.0, window, region, {});
  ASSERT_FALSE(turned.modes.empty());
  EXPECT_LT(turned.modes[0].pearson, 0.7);
}

TEST(Search, ManyThreadsGiveToTheLastBitWhatOneGives) {
  const RoadGrid map = street_map(7, {4.0, {75'000, -1'000'000}, 1500, 1400});
  std::mt19937_64 random(8);
  const PoseRegion region = all_poses_in(map.geometry.box());
  const FeatureMap seen = observed_at(map, pose_within(region.box, 400.0, random), 110, 110, 4.0, {0.4, 0.4}, random);
  SearchOptions options;
  const SearchResult one = search(reader_of(map), 4.0, seen, region, options);
  options.threads = 4;
  const SearchResult four = search(reader_of(map), 4.0, seen, region, options);
  EXPECT_EQ(one.background.poses, four.background.poses);
  EXPECT_EQ(one.background.sd, four.background.sd);
  EXPECT_EQ(one.background.rivals, four.background.rivals);
  ASSERT_EQ(one.modes.size(), four.modes.size());
  for (std::size_t i = 0; i < one.modes.size(); ++i) {
    EXPECT_EQ(one.modes[i].pose.position, four.modes[i].pose.position) << "mode " << i;
    EXPECT_EQ(one.modes[i].pose.heading, four.modes[i].pose.heading) << "mode " << i;
    EXPECT_EQ(one.modes[i].score, four.modes[i].score) << "mode " << i;
    EXPECT_EQ(one.modes[i].covariance, four.modes[i].covariance) << "mode " << i;
  }
}

TEST(Search, TellsHowFarItIsOverHeadingsAndSizes) {
  const RoadGrid map = street_map(7, town(400, 400));
  const PoseRegion region = all_poses_in(map.geometry.box());
  const GridPose pose{region.box.centre(), {}};
  std::vector<std::int64_t> told;
  SearchOptions options;
  options.threads = 4;
  options.scale_range = 0.02;
  std::int64_t all = 0;
  options.progress = [&](std::int64_t done, std::int64_t total) {
    told.push_back(done);
    all = total;
  };
  const SearchResult found = search(reader_of(map), 2.0, cut_out(map, pose, 64, 64, 2.0), region, options);
  ASSERT_GT(found.scales, 1);
  EXPECT_EQ(all, std::int64_t{found.headings} * found.scales);
  ASSERT_GT(told.size(), 2U);
  EXPECT_GT(told.front(), 0);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), all);
}

TEST(Search, AgainWithWhatWasKeptGivesTheSame) {
  const RoadGrid map = street_map(20, town(900, 800));
  std::mt19937_64 random(21);
  const PoseRegion region = all_poses_in(map.geometry.box());
  const FeatureMap window = cut_out(map, pose_within(region.box, 200.0, random), 130, 130, 2.0);
  SearchOptions options;
  options.proof_time = std::chrono::minutes(5);
  const SearchResult plain = search(reader_of(map), 2.0, window, region, options);
  options.cache = std::make_shared<SearchCache>(std::size_t{1} << 30);
  search(reader_of(map), 2.0, window, region, options);
  const std::size_t kept = options.cache->bytes();
  EXPECT_GT(kept, 0U);
  const SearchResult warm = search(reader_of(map), 2.0, window, region, options);
  EXPECT_EQ(options.cache->bytes(), kept);
  ASSERT_EQ(warm.modes.size(), plain.modes.size());
  EXPECT_EQ(warm.modes[0].score, plain.modes[0].score);
  EXPECT_EQ(warm.background.sd, plain.background.sd);
  EXPECT_EQ(warm.proof->bound, plain.proof->bound);
}

TEST(Search, HasSeenNothingAtItsDeadlineAndEndsWhenStopped) {
  const RoadGrid map = street_map(7, town(800, 800));
  std::mt19937_64 random(9);
  const PoseRegion region = all_poses_in(map.geometry.box());
  const FeatureMap window = cut_out(map, pose_within(region.box, 200.0, random), 128, 128, 2.0);
  SearchOptions options;
  options.deadline = Deadline({}, std::chrono::steady_clock::now());
  const SearchResult nothing = search(reader_of(map), 2.0, window, region, options);
  EXPECT_EQ(nothing.scanned_share, 0.0);
  EXPECT_FALSE(nothing.complete());
  EXPECT_TRUE(nothing.modes.empty());
  std::stop_source source;
  source.request_stop();
  options = {};
  options.deadline = Deadline(source.get_token());
  EXPECT_EQ(testing::code_of([&] { search(reader_of(map), 2.0, window, region, options); }), "search-stopped");
}

TEST(Search, OnAMapWithoutObservedGroundThereIsNoMode) {
  const RoadGrid map = RoadGrid::unobserved(town(800, 800));
  std::mt19937_64 random(9);
  const PoseRegion region = all_poses_in(map.geometry.box());
  const FeatureMap features = FeatureMap::centred(testing::smooth_cells(random, 64, 64), 2.0);
  EXPECT_TRUE(search(reader_of(map), 2.0, features, region, {}).modes.empty());
}

}  // namespace
}  // namespace roadfix
