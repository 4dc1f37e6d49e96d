#include "core/track/convergence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace roadfix {
namespace {

/// All that decides on a claim, as it is just enough for one.
struct Belief {
  TrackSettings settings;
  TrackerState state;
  Cluster best;
  Measurement measurement = Measurement::kUseless;
  double doubt = 0.4;

  Belief() {
    state.last = StepStamp{0, 59'999'999};
    state.accepted_time_us = 0;
    state.claim.supported = 3;
    state.claim.log_odds = std::log(100.0);
    state.claim.confirmed = true;
    state.claim.looked_time_us = 0;
    best.weight = 0.9;
    with_sigma_m(25.0);
  }
  void with_sigma_m(double sigma_m) {
    best.covariance[0][0] = sigma_m * sigma_m;
    best.covariance[1][1] = 1.0;
  }
  std::optional<Unclaimed> unclaimed() const { return why_unclaimed(settings, state, best, measurement, doubt); }
};

/// What alone takes a claim back, and how that is told.
struct Broken {
  Unclaimed told;
  std::string what;
  std::function<void(Belief&)> breaks;
};

const std::vector<Broken> kOfAllFilters{
    {Unclaimed::kSeveralPlaces, "less than 90 % of the weight is there", [](Belief& b) { b.best.weight = 0.899; }},
    {Unclaimed::kPlaceTooWide, "it is wider than 25 m", [](Belief& b) { b.with_sigma_m(25.1); }},
    {Unclaimed::kFrameRejected, "the picture was rejected", [](Belief& b) { b.measurement = Measurement::kRejected; }},
    {Unclaimed::kFrameRepeated, "the picture was seen before",
     [](Belief& b) { b.measurement = Measurement::kRepeated; }},
    {Unclaimed::kFrameRepeated, "the camera stands still", [](Belief& b) { b.state.last_view.stands_still = true; }},
    {Unclaimed::kTooFewAgree, "two more accepted than rejected", [](Belief& b) { b.state.claim.supported = 2; }},
    {Unclaimed::kNoneAgreedLately, "the last accepted a minute ago",
     [](Belief& b) { b.state.last->time_us = 60'000'000; }},
    {Unclaimed::kNoneAgreedLately, "none was accepted", [](Belief& b) { b.state.accepted_time_us.reset(); }},
    {Unclaimed::kFramesAgreeLess, "more doubt", [](Belief& b) { b.doubt = 0.401; }},
};
const Broken kChance{Unclaimed::kMayBeChance, "99 to 1 against chance",
                     [](Belief& b) { b.state.claim.log_odds = std::log(99.0); }};
const std::vector<Broken> kOfSearches{
    {Unclaimed::kOthersNotRuledOut, "no search ruled out other places",
     [](Belief& b) { b.state.claim.confirmed = false; }},
    {Unclaimed::kNotBorneOut, "no local search bore it out", [](Belief& b) { b.state.claim.looked_time_us.reset(); }},
};

void expect_claimed(const Belief& belief) { EXPECT_EQ(belief.unclaimed(), std::nullopt); }

void expect_taken_back(Belief belief, const Broken& by) {
  by.breaks(belief);
  EXPECT_EQ(belief.unclaimed(), by.told) << by.what;
}

void expect_no_matter(Belief belief, const Broken& what) {
  what.breaks(belief);
  EXPECT_EQ(belief.unclaimed(), std::nullopt) << what.what;
}

TEST(Convergence, WantsEveryConditionOfAClaim) {
  const Belief claimed;
  expect_claimed(claimed);
  for (const Broken& by : kOfAllFilters) expect_taken_back(claimed, by);
  expect_taken_back(claimed, kChance);
  for (const Broken& by : kOfSearches) expect_taken_back(claimed, by);
}

TEST(Convergence, IsExplainedByAllThatMayBeBehindIt) {
  const auto says = [](Unclaimed why, const std::string& words) {
    return std::string(explanation_of(why)).find(words) != std::string::npos;
  };
  EXPECT_TRUE(says(Unclaimed::kFrameRejected, "how the camera is turned against the nose"));
  EXPECT_TRUE(says(Unclaimed::kFrameRepeated, "if the vehicle hovers, its odometry drifts"));
  EXPECT_TRUE(says(Unclaimed::kOthersNotRuledOut, "searches end for lack of time"));
}

TEST(Convergence, IsExplainedByTheFirstConditionThatFails) {
  const std::vector<Unclaimed> order{Unclaimed::kFrameRepeated,     Unclaimed::kFrameRejected,
                                     Unclaimed::kSeveralPlaces,     Unclaimed::kPlaceTooWide,
                                     Unclaimed::kTooFewAgree,       Unclaimed::kNoneAgreedLately,
                                     Unclaimed::kFramesAgreeLess,   Unclaimed::kMayBeChance,
                                     Unclaimed::kOthersNotRuledOut, Unclaimed::kNotBorneOut};
  std::vector<Broken> all = kOfAllFilters;
  all.push_back(kChance);
  all.insert(all.end(), kOfSearches.begin(), kOfSearches.end());
  const auto place_of = [&](Unclaimed told) { return std::ranges::find(order, told); };
  for (const Broken& one : all) {
    for (const Broken& other : all) {
      Belief belief;
      one.breaks(belief);
      other.breaks(belief);
      const bool overwrites = belief.measurement == Measurement::kRejected && one.told == Unclaimed::kFrameRepeated;
      if (overwrites) continue;  // a step has one measurement
      EXPECT_EQ(belief.unclaimed(), *std::min(place_of(one.told), place_of(other.told)))
          << one.what << ", " << other.what;
    }
  }
}

TEST(Convergence, WantsNoPictureAtEveryStep) {
  Belief belief;
  for (const Measurement other : {Measurement::kNone, Measurement::kSearched, Measurement::kAccepted}) {
    belief.measurement = other;
    EXPECT_EQ(belief.unclaimed(), std::nullopt) << word_of(kMeasurements, other);
  }
}

TEST(Convergence, WantsNoSearchOfAFilterThatMakesNone) {
  Belief alone;
  alone.settings.recovers = false;
  expect_claimed(alone);
  for (const Broken& by : kOfAllFilters) expect_taken_back(alone, by);
  expect_taken_back(alone, kChance);
  for (const Broken& what : kOfSearches) expect_no_matter(alone, what);
}

TEST(Convergence, WantsTheFirstThreeConditionsAloneOfThePapersFilter) {
  Belief papers;
  papers.settings = TrackSettings::paper(100);
  expect_claimed(papers);
  for (const Broken& by : kOfAllFilters) expect_taken_back(papers, by);
  expect_no_matter(papers, kChance);
  for (const Broken& what : kOfSearches) expect_no_matter(papers, what);
}

}  // namespace
}  // namespace roadfix
