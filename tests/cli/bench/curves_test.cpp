#include "cli/bench/curves.hpp"

#include <gmock/gmock.h>

namespace roadfix::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Curves, PutAPointWhereProbabilityAndTruthMeet) {
  Honesty honesty;
  honesty.n = 4;
  honesty.bins = {{4, 0.5, 2}};
  // The middle of a square of 320 with a margin of 56.
  EXPECT_THAT(reliability_svg(honesty), HasSubstr("<circle cx=\"216.0\" cy=\"216.0\""));
}

TEST(Curves, LeaveOutQueriesElsewhereAndRealFrames) {
  SetResult on_map{"roads", "town", "simulated", {Outcome{}}, 400.0, false};
  SetResult elsewhere{"roads", "town", "simulated elsewhere", {Outcome{}}, 300.0, true};
  SetResult frames{"roads", "town", "frames.csv", {Outcome{}}, 0.0, false};
  const std::vector<SetResult> results{on_map, elsewhere, frames};
  EXPECT_THAT(answered_svg(results), HasSubstr("cx=\"322.7\""));  // 400 of 480 m
  EXPECT_THAT(answered_svg(results), Not(HasSubstr("cx=\"256.0\"")));
  EXPECT_THAT(answered_svg({}), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace roadfix::bench
