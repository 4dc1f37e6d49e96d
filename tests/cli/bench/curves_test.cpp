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
  SetResult on_map{MethodName::kRoads, "town", "simulated", {Outcome{}}, 400.0, false};
  SetResult elsewhere{MethodName::kRoads, "town", "simulated elsewhere", {Outcome{}}, 300.0, true};
  SetResult frames{MethodName::kRoads, "town", "frames.csv", {Outcome{}}, 0.0, false};
  const std::vector<SetResult> results{on_map, elsewhere, frames};
  EXPECT_THAT(answered_svg(results), HasSubstr("cx=\"322.7\""));  // 400 of 480 m
  EXPECT_THAT(answered_svg(results), Not(HasSubstr("cx=\"256.0\"")));
  EXPECT_THAT(answered_svg({}), HasSubstr("</svg>"));
}

TEST(Curves, OfAPropertyTakeTheSetsThatDifferInNothingElse) {
  const auto set_of = [](const FeatureQuality& quality) {
    SetResult set{MethodName::kRoads, "town", "simulated", {Outcome{}}, 400.0, false, quality};
    set.outcomes[0].error_m = 3.0;
    return set;
  };
  const std::vector<SetResult> results{set_of({}), set_of({.erase = 0.5}), set_of({.erase = 0.25, .invent = 0.5})};
  const auto erased = degraded_svg(results, &FeatureQuality::erase, "erased");
  ASSERT_TRUE(erased);
  EXPECT_THAT(*erased, HasSubstr("cx=\"322.7\" cy=\"376.0\""));  // 0.5 of 0.6, nothing answered
  EXPECT_THAT(*erased, HasSubstr("cx=\"325.9\" cy=\"56.0\""));   // beside it, all right
  EXPECT_THAT(*erased, Not(HasSubstr("cx=\"189.3\""))) << "0.25, where roads were invented too";
  EXPECT_FALSE(degraded_svg(results, &FeatureQuality::invent, "invented")) << "a point makes no curve";
  EXPECT_FALSE(degraded_svg({}, &FeatureQuality::erase, "erased"));
}

}  // namespace
}  // namespace roadfix::bench
