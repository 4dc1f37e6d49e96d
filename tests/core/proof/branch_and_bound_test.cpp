#include "core/proof/branch_and_bound.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <utility>

#include "tests/core/proof/bounded_case.hpp"

namespace roadfix {
namespace {

using testing::BoundedCase;

TEST(BranchAndBound, FindsTheBestScoreOfBruteForceOnRandomSmallMaps) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    testing::expect_brute_force_agrees(BoundedCase(seed));
  }
}

// Cases of which a bound from the most roads at one position and the most certain ones at another excluded the best
// pose.
TEST(BranchAndBound, HoldsWherePositionsOfABlockDifferInHowSureTheirRoadsAre) {
  for (const std::uint64_t seed : {571U, 579U, 639U, 1851U}) {
    SCOPED_TRACE(seed);
    testing::expect_brute_force_agrees(BoundedCase(seed));
  }
}

// Blocks of 4 x 4 positions are bounded in tiles of 64 x 16 blocks: here the last column and row begin tiles of their
// own.
TEST(BranchAndBound, FindsTheBestPoseOfEachRowAndColumnOfAMapOfSeveralTiles) {
  const RoadGrid map = testing::grid_city({4.0, {1003, -1001}, 257, 129}, 70.0);
  std::mt19937_64 random(5);
  const GridPose pose{map.geometry.cell_center(128, 64), Angle::degrees(40.0)};
  BoundedCase given(map, testing::observed_at(map, pose, 14, 10, 4.0, {0.2, 0.2}, random));
  const auto expect_best_among = [&](std::function<bool(int, int)> eligible) {
    given.search.eligible = std::move(eligible);
    EXPECT_GT(given.brute_force().score, 0.0);
    testing::expect_brute_force_agrees(given);
  };
  for (int only = 0; only < map.geometry.rows; only += 4) {
    SCOPED_TRACE(only);
    expect_best_among([only](int, int row) { return row == only; });
  }
  for (const int only : {0, 128, 255, 256}) {
    SCOPED_TRACE(only);
    expect_best_among([only](int col, int) { return col == only; });
  }
}

TEST(BranchAndBound, NeedsNoPoseToBeginWith) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const BoundedCase given(seed);
    const BoundedResult found = search_with_bound(given.search, Deadline());
    EXPECT_EQ(found.bound, given.brute_force().score);
  }
}

TEST(BranchAndBound, ProvesThatTheBestPoseIsTheBest) {
  BoundedCase given(3);
  given.search.known = given.brute_force().score;
  const BoundedResult found = search_with_bound(given.search, Deadline());
  EXPECT_FALSE(found.better.has_value());
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.bound, given.search.known);
}

TEST(BranchAndBound, SaysThatNothingIsExcludedWhenTimeWasOverAtOnce) {
  BoundedCase given(4);
  given.search.known = 0.1;
  const BoundedResult found = search_with_bound(given.search, Deadline({}, std::chrono::steady_clock::now()));
  EXPECT_FALSE(found.complete);
  EXPECT_EQ(found.excluded_share, 0.0);
  EXPECT_GE(found.bound, given.brute_force().score);
}

// On a grid of streets many poses fit alike.
TEST(BranchAndBound, ManyThreadsFindWhatOneFinds) {
  for (std::uint64_t seed = 1; seed < 40; seed += 4) {
    SCOPED_TRACE(seed);
    BoundedCase given(seed);
    const BoundedResult one = search_with_bound(given.search, Deadline());
    given.search.threads = 4;
    const BoundedResult four = search_with_bound(given.search, Deadline());
    EXPECT_EQ(one.bound, four.bound);
    EXPECT_EQ(one.complete, four.complete);
    ASSERT_EQ(one.better.has_value(), four.better.has_value());
    if (one.better) testing::expect_same(*four.better, *one.better);
  }
}

TEST(BranchAndBound, NoThreadsAreOne) {
  BoundedCase given(1);
  const BoundedResult one = search_with_bound(given.search, Deadline());
  given.search.threads = 0;
  EXPECT_EQ(search_with_bound(given.search, Deadline()).bound, one.bound);
}

}  // namespace
}  // namespace roadfix
