#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "core/grid/resample.hpp"
#include "core/search/search.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/repeats.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::all_poses_in;
using testing::grid_city;
using testing::observed_at;
using testing::pose_within;
using testing::reader_of;
using testing::repeats;
using testing::street_map;

TEST(SearchProof, IsGivenWhereItIsAskedFor) {
  const RoadGrid map = street_map(14, {2.0, {150'000, -2'000'000}, 500, 450});
  std::mt19937_64 random(15);
  const PoseRegion region = all_poses_in(map.geometry.box());
  const GridPose truth = pose_within(region.box, 200.0, random);
  const FeatureMap seen = observed_at(map, truth, 150, 150, 2.0, {0.2, 0.2}, random);
  SearchOptions options;
  options.proof_time = std::chrono::minutes(5);
  const SearchResult found = search(reader_of(map), 2.0, seen, region, options);
  ASSERT_TRUE(found.proof.has_value());
  EXPECT_TRUE(found.proof->complete);
  EXPECT_EQ(found.proof->cell_m, 4.0);
  EXPECT_EQ(found.proof->bound, found.proof->best_score);
  EXPECT_EQ(found.proof->excluded_share, 1.0);
  EXPECT_LT(distance_m(found.modes[0].pose.position, truth.position), 2.0);
  options.proof_time = std::chrono::milliseconds(1);
  EXPECT_FALSE(search(reader_of(map), 2.0, seen, region, options).proof->complete);
}

TEST(SearchProof, ReadsNoMapWhenTimeIsOver) {
  const RoadGrid map = street_map(14, {2.0, {150'000, -2'000'000}, 300, 300});
  const FeatureMap seen = cut_out(map, {map.geometry.box().centre(), Angle()}, 150, 150, 2.0);
  int read = 0;
  const auto counting = [&](const GridGeometry& window) {
    if (window.cell_m == 4.0) ++read;
    return reader_of(map)(window);
  };
  SearchOptions options;
  options.proof_time = std::chrono::minutes(5);
  options.deadline = Deadline({}, std::chrono::steady_clock::now());
  const SearchResult found = search(counting, 2.0, seen, all_poses_in(map.geometry.box()), options);
  EXPECT_EQ(read, 0);
  ASSERT_TRUE(found.proof.has_value());
  EXPECT_FALSE(found.proof->complete);
  EXPECT_EQ(found.proof->bound, 1.0);
  EXPECT_EQ(found.proof->excluded_share, 0.0);
}

// On a map of 500 km2 its planes take seconds, and what was left of the time was theirs.
TEST(SearchProof, MakesNothingOfTheMapWhenTimeEndsAsItIsRead) {
  const RoadGrid map = street_map(14, {2.0, {150'000, -2'000'000}, 300, 300});
  const FeatureMap seen = cut_out(map, {map.geometry.box().centre(), Angle()}, 150, 150, 2.0);
  SearchOptions options;
  options.cache = std::make_shared<SearchCache>(std::size_t{1} << 30);
  const PoseRegion region = all_poses_in(map.geometry.box());
  search(reader_of(map), 2.0, seen, region, options);
  const std::size_t kept = options.cache->bytes();
  options.proof_time = std::chrono::milliseconds(500);
  const auto slowly = [&](const GridGeometry& window) {
    if (window.cell_m == 4.0) std::this_thread::sleep_for(*options.proof_time);
    return reader_of(map)(window);
  };
  const SearchResult found = search(slowly, 2.0, seen, region, options);
  EXPECT_EQ(options.cache->bytes(), kept);
  EXPECT_FALSE(found.proof->complete);
  EXPECT_EQ(found.proof->bound, 1.0);
  EXPECT_TRUE(found.complete());
}

TEST(SearchProof, TellsNoScoreOfCoarserCellsWhereTimeEndsBeforeItsOwnAreLookedAt) {
  const RoadGrid map = street_map(14, {2.0, {150'000, -2'000'000}, 300, 300});
  const FeatureMap seen = cut_out(map, {map.geometry.box().centre(), Angle()}, 150, 150, 2.0);
  const std::chrono::milliseconds limit(1500);
  const auto slowly = [&](const GridGeometry& window) {
    if (window.cell_m == 4.0) std::this_thread::sleep_for(limit);
    return reader_of(map)(window);
  };
  SearchOptions options;
  options.proof_time = std::chrono::minutes(5);
  options.deadline = Deadline({}, std::chrono::steady_clock::now() + limit);
  const SearchResult found = search(slowly, 2.0, seen, all_poses_in(map.geometry.box()), options);
  EXPECT_FALSE(found.refined);
  EXPECT_EQ(found.proof->best_score, 0.0);
  EXPECT_EQ(found.proof->bound, 1.0);
}

TEST(SearchProof, IsOverAllScalesToo) {
  const RoadGrid map = street_map(18, {2.0, {150'000, -2'000'000}, 350, 300});
  std::mt19937_64 random(19);
  PoseRegion region = all_poses_in(map.geometry.box());
  const GridPose truth = pose_within(region.box, 180.0, random);
  FeatureMap window = cut_out(map, truth, 130, 130, 2.1);
  window.cell_m = 2.0;
  region.heading = truth.heading;
  region.heading_half_width = Angle::degrees(10.0);
  SearchOptions options;
  options.scale_range = 0.06;
  options.proof_time = std::chrono::minutes(5);
  const SearchResult found = search(reader_of(map), 2.0, window, region, options);
  ASSERT_TRUE(found.proof.has_value());
  EXPECT_TRUE(found.proof->complete);
  EXPECT_GT(found.proof->scales, found.scales);
  EXPECT_EQ(found.proof->bound, found.proof->best_score);
  EXPECT_NEAR(found.modes[0].scale, 1.05, 0.01);
}

TEST(SearchProof, IsByMeansOfItsOwnFinestCellsWhateverWasKept) {
  const RoadGrid finer = street_map(22, {1.0, {300'000, -4'000'000}, 900, 800});
  RoadGrid map = reader_of(finer)({2.0, {150'000, -2'000'000}, 450, 400});
  const GridPose pose{map.geometry.box().centre(), Angle::degrees(31.0)};
  const FeatureMap window = cut_out(map, pose, 270, 270, 2.0);
  paste(CellArray(map.geometry.cols, 60, kNoRoad), map.cells, 0, map.geometry.rows / 2);
  PoseRegion region = all_poses_in(grown({pose.position, pose.position}, 10.0));
  region.heading = pose.heading;
  region.heading_half_width = Angle::degrees(20.0);
  SearchOptions options;
  options.proof_time = std::chrono::minutes(5);
  const SearchResult fresh = search(reader_of(map), 2.0, window, region, options);
  ASSERT_TRUE(fresh.proof->complete);
  options.cache = std::make_shared<SearchCache>(std::size_t{1} << 30);
  // Too many of the finest cells across: their level is left out, and the next is the finest of both searches.
  const SearchResult other = search(reader_of(finer), 1.0, cut_out(finer, pose, 540, 540, 1.0), region, options);
  ASSERT_EQ(other.cell_m, fresh.cell_m);
  const SearchResult again = search(reader_of(map), 2.0, window, region, options);
  EXPECT_EQ(again.proof->bound, fresh.proof->bound);
}

TEST(SearchProof, IsOverThePosesBesideARegionThatHoldsNone) {
  const RoadGrid map = street_map(14, {2.0, {150'000, -2'000'000}, 300, 300});
  const GridPoint corner = map.geometry.point_at({150.0, 150.0});  // of cells of 4 m too
  std::mt19937_64 random(15);
  const FeatureMap seen = observed_at(map, {corner, Angle::degrees(40.0)}, 150, 150, 2.0, {0.2, 0.2}, random);
  PoseRegion region = all_poses_in(grown({corner, corner}, 0.1));
  region.heading_half_width = Angle();
  SearchOptions options;
  options.proof_time = std::chrono::minutes(5);
  for (double heading = 39.0; heading < 41.0; heading += 0.23) {
    region.heading = Angle::degrees(heading);
    const SearchResult found = search(reader_of(map), 2.0, seen, region, options);
    EXPECT_TRUE(found.proof->complete);
    EXPECT_GE(found.proof->headings, 2);
    EXPECT_GT(found.proof->best_score, 0.5) << heading;
  }
}

// Where streets meet at right angles many poses fit alike, and a proof goes from one to the next.
TEST(SearchProof, LeadsToTheSameAnswerWithAnyNumberOfThreads) {
  const RoadGrid map = grid_city({2.0, {150'000, -2'000'000}, 160, 160}, 60.0);
  const PoseRegion region = all_poses_in(map.geometry.box());
  SearchOptions options;
  options.proof_time = std::chrono::minutes(5);
  for (const std::uint64_t seed : {10U, 11U}) {
    std::mt19937_64 random(seed);
    const FeatureMap seen = observed_at(map, pose_within(region.box, 100.0, random), 70, 70, 2.0, {0.3, 0.5}, random);
    options.threads = 1;
    const SearchResult one = search(reader_of(map), 2.0, seen, region, options);
    for (int run = 0; run < repeats(3); ++run) {
      options.threads = 4;
      const SearchResult four = search(reader_of(map), 2.0, seen, region, options);
      EXPECT_EQ(four.background.rivals, one.background.rivals);
      EXPECT_EQ(four.modes.at(0).pose.position, one.modes.at(0).pose.position);
      EXPECT_EQ(four.modes.at(0).score, one.modes.at(0).score);
    }
  }
}

}  // namespace
}  // namespace roadfix
