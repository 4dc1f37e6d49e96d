#include "core/locate/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
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
  bool converged() const { return has_converged(settings, state, best, measurement, doubt); }
};

/// What alone takes a claim back, and in words.
using Broken = std::pair<std::string, std::function<void(Belief&)>>;

const std::vector<Broken> kOfAllFilters{
    {"less than 90 % of the weight is there", [](Belief& b) { b.best.weight = 0.899; }},
    {"it is wider than 25 m", [](Belief& b) { b.with_sigma_m(25.1); }},
    {"the picture was rejected", [](Belief& b) { b.measurement = Measurement::kRejected; }},
    {"the picture was seen before", [](Belief& b) { b.measurement = Measurement::kRepeated; }},
    {"the camera stands still", [](Belief& b) { b.state.last_view.stands_still = true; }},
    {"two more accepted than rejected", [](Belief& b) { b.state.claim.supported = 2; }},
    {"the last accepted a minute ago", [](Belief& b) { b.state.last->time_us = 60'000'000; }},
    {"none was accepted", [](Belief& b) { b.state.accepted_time_us.reset(); }},
    {"more doubt", [](Belief& b) { b.doubt = 0.401; }},
};
const Broken kChance{"99 to 1 against chance", [](Belief& b) { b.state.claim.log_odds = std::log(99.0); }};
const std::vector<Broken> kOfSearches{
    {"no search ruled out other places", [](Belief& b) { b.state.claim.confirmed = false; }},
    {"no local search bore it out", [](Belief& b) { b.state.claim.looked_time_us.reset(); }},
};

void expect_claimed(const Belief& belief) { EXPECT_TRUE(belief.converged()); }

void expect_taken_back(Belief belief, const Broken& by) {
  by.second(belief);
  EXPECT_FALSE(belief.converged()) << by.first;
}

void expect_no_matter(Belief belief, const Broken& what) {
  what.second(belief);
  EXPECT_TRUE(belief.converged()) << what.first;
}

TEST(Convergence, WantsEveryConditionOfAClaim) {
  const Belief claimed;
  expect_claimed(claimed);
  for (const Broken& by : kOfAllFilters) expect_taken_back(claimed, by);
  expect_taken_back(claimed, kChance);
  for (const Broken& by : kOfSearches) expect_taken_back(claimed, by);
}

TEST(Convergence, WantsNoPictureAtEveryStep) {
  Belief belief;
  for (const Measurement other : {Measurement::kNone, Measurement::kSearched, Measurement::kAccepted}) {
    belief.measurement = other;
    EXPECT_TRUE(belief.converged()) << to_string(other);
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
