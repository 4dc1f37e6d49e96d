#include "core/locate/decision.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace roadfix {
namespace {

using ::testing::HasSubstr;

/// A best place of `score` among rivals that thin out from `second` to `lowest`.
SearchResult found(double score, double second, double lowest) {
  SearchResult result;
  result.cell_m = 2.0;
  result.background.sd = 0.05;
  result.background.poses = 1'000'000;
  constexpr int kRivals = 80;
  for (int i = 0; i < kRivals; ++i) {
    // Order statistics of an exponential tail.
    const double share = std::log((i + 1.0) / kRivals) / std::log(1.0 / kRivals);
    result.background.rivals.push_back(lowest + (second - lowest) * share);
  }
  result.background.rivals_within = result.background.rivals;
  SearchMode best;
  best.score = best.pearson = score;
  best.observed_cells = 40'000;    // 400 x 400 m
  result.other_roads_m = 2 * 400;  // two roads across beside the two longest
  SearchMode next = best;
  next.score = next.pearson = second;
  result.modes = {best, next};
  return result;
}

/// Within 10 m of the best place, of a frame that shows roads enough.
Decision decided(const SearchResult& result, double confidence = 0.99, bool bare = false,
                 const Calibration& calibration = *shipped_calibration()) {
  PoseRegion region;
  region.box = {{-10.0, -10.0}, {10.0, 10.0}};
  return decide(result, region, calibration, confidence, bare);
}

TEST(Decision, APlaceFarAboveAllOthersIsAFix) {
  const Decision decision = decided(found(0.8, 0.35, 0.2));
  EXPECT_EQ(decision.status, FixStatus::kFix);
  EXPECT_GE(decision.probability, 0.99);
  EXPECT_TRUE(decision.reason.empty());
  EXPECT_GT(decision.weights[0], decision.weights[1]);
  EXPECT_EQ(decided(found(0.8, 0.35, 0.2), decision.probability).status, FixStatus::kFix) << "as sure as asked for";
}

TEST(Decision, APlaceThatFollowsTheTailOfChanceIsNone) {
  const Decision decision = decided(found(0.38, 0.35, 0.2));
  EXPECT_EQ(decision.status, FixStatus::kNoFix);
  EXPECT_EQ(decision.reason, "not-above-chance");
  EXPECT_LT(decision.probability, 0.5);
}

TEST(Decision, WhatChanceExplainsOfABareFrameHasTooFewRoads) {
  constexpr bool kBare = true;
  for (const double other_roads_m : {150.0, 800.0}) {
    SearchResult result = found(0.38, 0.35, 0.2);
    result.other_roads_m = other_roads_m;
    const Decision decision = decided(result, 0.99, kBare);
    EXPECT_EQ(decision.status, FixStatus::kNoFix);
    EXPECT_EQ(decision.reason, "too-few-roads");
    EXPECT_THAT(decision.explanation, ::testing::HasSubstr("less road than a single one"));
  }
  EXPECT_EQ(decided(found(0.8, 0.35, 0.2), 0.99, kBare).status, FixStatus::kFix);
  EXPECT_EQ(decided(found(0.85, 0.84, 0.7), 0.99, kBare).reason, "several-places-fit");
}

TEST(Decision, NoPlaceThatIsLikelyIsCalledChance) {
  bool likely = false;
  for (double score = 0.38; score < 0.6; score += 0.01) {
    const Decision decision = decided(found(score, 0.35, 0.2));
    if (decision.status != FixStatus::kNoFix) continue;
    EXPECT_EQ(decision.reason, decision.probability > 0.5 ? "below-confidence" : "not-above-chance") << score;
    likely = likely || decision.probability > 0.5;
  }
  EXPECT_TRUE(likely);
}

TEST(Decision, AnUnlikelyPlaceIsAmbiguousOnceChanceLetsFewerThanOneInAHundredFitAsWell) {
  int ambiguous = 0;
  int by_chance = 0;
  for (double score = 0.36; score < 0.7; score += 0.01) {
    SearchResult result = found(score, 0.35, 0.2);
    result.modes[0].pearson = 0.1;  // so little is no surprise by itself
    result.modes[1].score = score;
    const Decision decision = decided(result);
    if (decision.probability > 0.5) continue;
    const bool beyond_chance = decision.figures->surprise >= std::log(100.0);
    EXPECT_EQ(decision.status, beyond_chance ? FixStatus::kAmbiguous : FixStatus::kNoFix) << score;
    ++(beyond_chance ? ambiguous : by_chance);
  }
  EXPECT_GT(ambiguous, 2);
  EXPECT_GT(by_chance, 2);
}

TEST(Decision, OfPlacesThatAreAmbiguousThoseAreToldThatAreAHundredthAsLikelyAsTheBest) {
  std::size_t told = 0;
  for (double second = 0.7; second < 0.8; second += 0.005) {
    const SearchResult result = found(0.8, second, 0.2);
    const Decision decision = decided(result, 0.9999);
    ASSERT_EQ(decision.status, FixStatus::kAmbiguous) << second;
    const double ratio = std::exp(result.background.log_likelihood(second) - result.background.log_likelihood(0.8));
    EXPECT_EQ(decision.weights.size(), ratio >= 0.01 ? 2U : 1U) << second;
    told += decision.weights.size() - 1;
  }
  EXPECT_TRUE(told > 2 && told < 18) << told;
}

TEST(Decision, PlacesThatFitTooWellForChanceAreAmbiguous) {
  const Decision decision = decided(found(0.85, 0.84, 0.7));
  EXPECT_EQ(decision.status, FixStatus::kAmbiguous);
  EXPECT_EQ(decision.reason, "several-places-fit");
}

TEST(Decision, APlaceThatIsSureButNotAsSureAsAskedIsAmbiguousAndAlone) {
  const SearchResult result = found(0.8, 0.35, 0.2);
  const Decision decision = decided(result, 0.9999);
  EXPECT_EQ(decision.status, FixStatus::kAmbiguous);
  EXPECT_EQ(decision.reason, "below-confidence");
  EXPECT_NE(decision.explanation.find("vouches for no more than 0.9965"), std::string::npos) << decision.explanation;
  Calibration doubtful = *shipped_calibration();
  doubtful.bias -= 20.0;
  const Decision doubted = decided(result, 0.9999, false, doubtful);
  EXPECT_EQ(doubted.reason, "below-confidence");
  EXPECT_EQ(doubted.explanation.find("vouches"), std::string::npos) << doubted.explanation;
  Calibration nearly;
  nearly.bias = std::log(0.96 / 0.04);
  nearly.highest = 0.99;
  const Decision less_sure = decided(result, 0.98, false, nearly);
  EXPECT_EQ(less_sure.reason, "below-confidence");
  EXPECT_EQ(less_sure.explanation.find("vouches"), std::string::npos) << "it does for as much as was asked for";
  EXPECT_EQ(decision.weights.size(), 1U);
}

TEST(Decision, APlaceThatRestsOnLittleBesideTwoStraightRoadsIsExplainedByChanceHoweverFarItIsAhead) {
  SearchResult result = found(0.8, 0.35, 0.2);
  result.other_roads_m = 150;
  const Decision decision = decided(result, 0.4);
  EXPECT_EQ(decision.status, FixStatus::kNoFix);
  EXPECT_EQ(decision.reason, "not-above-chance");
  EXPECT_NE(decision.explanation.find("share 150 m of road beside the longest straight ones, and 160 m are needed"),
            std::string::npos)
      << decision.explanation;
  EXPECT_LE(decision.probability, 0.5);
  EXPECT_EQ(decision.weights.size(), 2U);
  result.other_roads_m = 170;
  EXPECT_EQ(decided(result).status, FixStatus::kFix);
}

class DecisionBesideOtherPlacesOutside : public ::testing::Test {
 protected:
  /// Places 60 m, 120 m, ... away, around a region that is this share of the ground that was looked at.
  Decision beside(const std::vector<double>& scores, double best = 0.8, double region_share = 1.0) {
    SearchResult result = found(best, 0.35, 0.2);
    result.background.region_share = region_share;
    for (const double score : scores) {
      result.outside.push_back(result.modes[0]);
      result.outside.back().score = score;
      result.outside.back().pose.position.east_m += 60.0 * static_cast<double>(result.outside.size());
    }
    return decided(result);
  }

  /// So far to the east, and as good.
  static Decision beside_one_at(double east_m) {
    SearchResult result = found(0.8, 0.35, 0.2);
    result.outside = {result.modes[0]};
    result.outside[0].pose.position.east_m = east_m;
    return decided(result);
  }
};

TEST_F(DecisionBesideOtherPlacesOutside, OneThatFitsBetterLeavesNoFix) {
  const Decision decision = beside({0.85});
  EXPECT_EQ(decision.status, FixStatus::kNoFix);
  EXPECT_EQ(decision.reason, "better-outside-prior");
  EXPECT_NE(decision.explanation.find("60 m"), std::string::npos) << decision.explanation;
  EXPECT_LT(decision.probability, 0.01);
  EXPECT_EQ(decision.weights.front(), decision.probability);
}

TEST_F(DecisionBesideOtherPlacesOutside, AWiderPriorIsAdvisedForOneWithinHalfAFootprintOfItsBorderAlone) {
  EXPECT_THAT(beside_one_at(205.0).explanation, HasSubstr("just outside of the prior, 205 m from the best place"));
  EXPECT_THAT(beside_one_at(205.0).explanation, HasSubstr("give a wider one"));
  const Decision far = beside_one_at(215.0);
  EXPECT_EQ(far.reason, "better-outside-prior");
  EXPECT_THAT(far.explanation, HasSubstr("well outside of the prior, 215 m from the best place"));
  EXPECT_THAT(far.explanation, HasSubstr("this ground repeats and no wider prior helps"));
}

TEST_F(DecisionBesideOtherPlacesOutside, OneThatFitsNearlyAsWellLeavesNoFixEither) {
  const Decision decision = beside({0.799});
  EXPECT_EQ(decision.reason, "better-outside-prior");
  EXPECT_GT(decision.probability, 0.5);
  EXPECT_LT(decision.probability, 0.6);
}

TEST_F(DecisionBesideOtherPlacesOutside, OneThatChanceDoesNotExplainIsTheReasonWhereNothingInsideFits) {
  EXPECT_EQ(beside({0.8}, 0.38).reason, "better-outside-prior");
  EXPECT_EQ(beside({0.39}, 0.38).reason, "not-above-chance") << "nothing fits outside either";
}

TEST_F(DecisionBesideOtherPlacesOutside,
       OneThatFitsALittleBetterThanALikelyPlaceIsTheReasonThoughChanceMayExplainBoth) {
  SearchResult result = found(0.42, 0.35, 0.2);
  result.outside = {result.modes[0]};
  result.outside[0].score = 0.425;
  result.modes[0].pearson = 0.1;
  Calibration sure;
  sure.bias = 10.0;
  sure.highest = 0.9;
  const Decision decision = decided(result, 0.99, false, sure);
  ASSERT_LT(decision.figures->surprise, 4.6);
  EXPECT_GT(decision.probability, 0.25);
  EXPECT_LT(decision.probability, 0.5);
  EXPECT_EQ(decision.reason, "better-outside-prior");
}

TEST_F(DecisionBesideOtherPlacesOutside, ChanceHasAllTheGroundAroundForOneHoweverSmallTheRegion) {
  EXPECT_EQ(beside({0.45}, 0.25, 0.01).reason, "not-above-chance");
  EXPECT_EQ(beside({0.8}, 0.25, 0.01).reason, "better-outside-prior");
}

TEST_F(DecisionBesideOtherPlacesOutside, OneThatFitsFarLessChangesNothing) {
  EXPECT_EQ(beside({0.7}).status, FixStatus::kFix);
  EXPECT_NEAR(beside({0.7}).probability, decided(found(0.8, 0.35, 0.2)).probability, 1e-4);
}

TEST_F(DecisionBesideOtherPlacesOutside, EachThatFitsAsWellTakesItsShare) {
  const double alone = beside({}).probability;
  EXPECT_NEAR(beside({0.8}).probability, alone / 2.0, 1e-9);
  EXPECT_NEAR(beside({0.8, 0.8, 0.8}).probability, alone / 4.0, 1e-9);
}

TEST(Decision, WeightsAreSharedByTheModes) {
  for (const double second : {0.3, 0.5, 0.7, 0.79, 0.8}) {
    const Decision decision = decided(found(0.8, second, 0.2));
    double sum = 0.0;
    for (const double weight : decision.weights) sum += weight;
    EXPECT_LE(sum, 1.0 + 1e-12);
    EXPECT_EQ(decision.weights.front(), decision.probability);
    EXPECT_TRUE(std::ranges::is_sorted(decision.weights, std::ranges::greater{}));
  }
}

TEST(Decision, WeightsOfPlacesThatFitAsWellAsASureOneShareWhatItLeaves) {
  Calibration sure;
  sure.bias = 10.0;
  sure.highest = 0.9;
  SearchResult result = found(0.8, 0.35, 0.2);
  result.modes.push_back(result.modes.front());
  result.modes[1].score = result.modes.front().score;
  const Decision decision = decided(result, 0.5, false, sure);
  ASSERT_EQ(decision.weights.size(), 3U);
  EXPECT_EQ(decision.weights[0], 0.9);
  EXPECT_NEAR(decision.weights[1], 0.05, 1e-9);
  EXPECT_NEAR(decision.weights[2], 0.05, 1e-9);
}

TEST(Decision, WithFewRivalsChanceIsUnknownAndNothingIsAFix) {
  SearchResult few = found(0.4, 0.1, 0.05);
  few.background.rivals.resize(5);
  EXPECT_EQ(decided(few, 0.9).status, FixStatus::kNoFix);
}

TEST(Decision, WhatATimeLimitEndedIsNoFixHoweverWellItFits) {
  SearchResult half = found(0.8, 0.35, 0.2);
  const double whole = decided(half).probability;
  half.scanned_share = 0.5;
  const Decision decision = decided(half, 0.5);
  EXPECT_EQ(decision.status, FixStatus::kNoFix);
  EXPECT_EQ(decision.reason, "search-time-limit");
  EXPECT_NEAR(decision.probability, 0.5 * whole, 1e-12);
  EXPECT_NE(decision.explanation.find("50 %"), std::string::npos);
  half.scanned_share = 1.0;
  half.refined = false;
  const Decision unrefined = decided(half, 0.5);
  EXPECT_EQ(unrefined.reason, "search-time-limit");
  EXPECT_THAT(unrefined.explanation, HasSubstr("before the candidates were compared at full resolution"));
  half.modes.clear();
  EXPECT_EQ(decided(half, 0.5).reason, "search-time-limit");
}

TEST(Decision, WithoutAnyModeTheMapIsTooEmpty) {
  const Decision decision = decided({});
  EXPECT_EQ(decision.status, FixStatus::kNoFix);
  EXPECT_EQ(decision.reason, "map-too-empty");
}

}  // namespace
}  // namespace roadfix
