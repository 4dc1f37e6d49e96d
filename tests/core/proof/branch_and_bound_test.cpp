#include "core/proof/branch_and_bound.hpp"

#include <gtest/gtest.h>

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
