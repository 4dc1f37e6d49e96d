#include "cli/bench/honesty.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace roadfix::bench {
namespace {

/// An answer of that probability, so far from the truth in units of its ellipse and in metres.
Outcome answered(double probability, double nees, double error_m) {
  Outcome outcome;
  outcome.answer.probability = probability;
  outcome.answer.mode = FixMode{};
  outcome.error_m = error_m;
  outcome.position_nees = nees;
  outcome.heading_nees = 0.5 * nees;
  return outcome;
}

TEST(Honesty, ComparesProbabilitiesWithWhatCameTrue) {
  std::vector<Outcome> outcomes;
  for (int i = 0; i < 10; ++i) outcomes.push_back(answered(0.8, i < 6 ? 1.0 : 900.0, i < 6 ? 2.0 : 400.0));
  for (int i = 0; i < 30; ++i) outcomes.push_back(answered(0.3, i < 9 ? 1.0 : 900.0, i < 9 ? 2.0 : 400.0));
  outcomes.push_back(Outcome{});  // nothing to search for
  const Honesty honesty = honesty_of(outcomes);
  EXPECT_EQ(honesty.n, 40);
  ASSERT_EQ(honesty.bins.size(), 2u);
  EXPECT_NEAR(honesty.bins[0].mean_probability, 0.3, 1e-12);
  EXPECT_EQ(honesty.bins[0].right, 9);
  EXPECT_EQ(honesty.bins[1].right, 6);
  EXPECT_NEAR(honesty.expected_calibration_error, 0.2 * 10 / 40, 1e-12);
}

TEST(Honesty, CountsWhatAConfidenceWouldHaveGiven) {
  const double nowhere = std::numeric_limits<double>::infinity();
  const std::vector<Outcome> outcomes{answered(0.95, 1.0, 3.0), answered(0.992, 20.0, 12.0),
                                      answered(0.9999, nowhere, nowhere), answered(0.5, 1.0, 2.0)};
  const Honesty honesty = honesty_of(outcomes);
  EXPECT_EQ(honesty.at[0].answered, 3);
  EXPECT_EQ(honesty.at[0].outside, 2);  // beyond 4 standard deviations
  EXPECT_EQ(honesty.at[0].false_fixes, 1);
  EXPECT_EQ(honesty.at[1].answered, 2);
  EXPECT_EQ(honesty.at[2].answered, 1);
  EXPECT_EQ(honesty.at[2].false_fixes, 1);
  EXPECT_EQ(honesty.position.n, 2);
  EXPECT_NEAR(honesty.position.mean_nees, 10.5, 1e-12);
  EXPECT_EQ(honesty.position.within_95, 1);
  EXPECT_NEAR(honesty.heading.mean_nees, 5.25, 1e-12);
  EXPECT_EQ(honesty.heading.within_95, 1);
  EXPECT_EQ(to_json(honesty)["at_confidence"][2]["false_fixes"], 1);
  EXPECT_NE(to_text(honesty).find("1 of 2 within their 95 %, 1 false left out"), std::string::npos);
}

TEST(Honesty, OfNothingIsSilent) {
  EXPECT_TRUE(to_text(honesty_of({})).empty());
  EXPECT_EQ(to_json(honesty_of({}))["n"], 0);
}

}  // namespace
}  // namespace roadfix::bench
