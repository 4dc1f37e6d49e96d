// What a filter makes of a measurement, by its weights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/filter/filter.hpp"
#include "tests/core/filter/square.hpp"

namespace roadfix {
namespace {

using testing::kSquare;

/// Particles of these weights at one place.
FilterState state_of(const std::vector<double>& weights) {
  FilterState state;
  state.particles.resize(weights.size());
  state.particles.weight = weights;
  return state;
}

TEST(Filter, KeepsItsBeliefWhereOnlyParticlesWithoutWeightCouldExplainTheMeasurement) {
  const FilterState before = state_of({0.5, 0.5, 0.0});
  Filter filter({}, {kSquare}, before);
  const double never = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(filter.correct(std::vector<double>{never, never, 0.0}).usable);
  EXPECT_EQ(filter.state(), before);
}

TEST(Filter, TellsHowLikelyAMeasurementIsInTheMeanOfItsBelief) {
  Filter filter({}, {kSquare}, state_of({0.5, 0.3, 0.2}));
  const std::vector<double> log_likelihoods{std::log(4.0), std::log(1.0), std::log(0.5)};
  EXPECT_NEAR(filter.correct(log_likelihoods).mean_likelihood, 0.5 * 4.0 + 0.3 * 1.0 + 0.2 * 0.5, 1e-12);
}

TEST(Filter, ResamplesWhereFewerParticlesCountThanItsShare) {
  const auto resamples = [](double share, const std::vector<double>& log_likelihoods) {
    FilterOptions options;
    options.effective_share = share;
    return Filter(options, {kSquare}, state_of({0.25, 0.25, 0.25, 0.25})).correct(log_likelihoods).resampled;
  };
  EXPECT_FALSE(resamples(0.5, {0.0, 0.0, -1000.0, -1000.0})) << "two of four";
  EXPECT_TRUE(resamples(0.5, {0.0, -1.0, -1000.0, -1000.0}));
  EXPECT_TRUE(resamples(1.0, {0.0, 0.0, 0.0, 0.0})) << "after every measurement";
}

TEST(Filter, DoubtsItsBeliefFromTheThirdMeasurementThatFitsWorseUntilAllOfThemDo) {
  Filter filter({}, {kSquare}, state_of({1.0}));
  const auto doubt_after = [&](double log_ratio, int measurements) {
    for (int i = 0; i < measurements; ++i) {
      filter.correct(std::vector<double>(filter.particles().size(), log_ratio));
    }
    return filter.doubt();
  };
  EXPECT_EQ(doubt_after(4.0, 200), 0.0);
  EXPECT_LT(doubt_after(-3.0, 2), 0.4);
  EXPECT_GT(doubt_after(-3.0, 1), 0.4);
  EXPECT_GT(doubt_after(-3.0, 47), 0.8);
  EXPECT_LT(doubt_after(-3.0, 150), 0.4);
}

TEST(Filter, DrawsAsManyElsewhereAsItDoubtsBeyondWhatFluctuates) {
  FilterState state = state_of(std::vector<double>(1'000, 0.001));
  state.fast_fit = 0.375;
  Filter filter({.max_particles = 1'000, .adapts_count = false, .roughening_m = 0.0}, {kSquare}, state);
  filter.correct(std::vector<double>(1'000, 0.0));
  EXPECT_NEAR(filter.doubt(), 0.2, 1e-9);
  const auto elsewhere = 1'000 - std::ranges::count(filter.particles().east_m, 0.0);
  EXPECT_NEAR(static_cast<double>(elsewhere), 1'000 * (0.2 - 0.15), 2.0);
}

TEST(Filter, InjectsInPlaceOfAnyParticlesWhateverTheirOrder) {
  FilterState state = state_of(std::vector<double>(1'000, 0.001));
  std::vector<double>& norths = state.particles.north_m;
  for (std::size_t i = 0; i < norths.size(); ++i) norths[i] = static_cast<double>(i);
  Filter filter({}, {kSquare}, state);
  const Proposal there{{{800.0, -1.0}, Angle()}, {}, 1.0};
  filter.inject(std::span(&there, 1), 0.5);
  const Particles& p = filter.particles();
  double left = 0.0;
  for (std::size_t i = 0; i < 1'000; ++i) left += p.east_m[i] == 0.0 ? p.north_m[i] / 500.0 : 0.0;
  EXPECT_NEAR(left, 499.5, 5.0 * std::sqrt(1'000.0 * 1'000.0 / 12.0 / 500.0)) << "their mean is that of all";
}

TEST(Filter, InjectsParticlesOfTheMeanWeight) {
  Filter filter({}, {kSquare}, state_of({0.1, 0.2, 0.3, 0.4}));
  const Proposal there{{{800.0, 700.0}, Angle()}, {}, 1.0};
  filter.inject(std::span(&there, 1), 0.25);
  const Particles& p = filter.particles();
  const auto drawn = static_cast<std::size_t>(std::ranges::find(p.east_m, 800.0) - p.east_m.begin());
  ASSERT_LT(drawn, 4U);
  const double sum = 1.0 - 0.1 * static_cast<double>(drawn + 1) + 0.25;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(p.weight[i], (i == drawn ? 0.25 : 0.1 * static_cast<double>(i + 1)) / sum, 1e-12) << i;
  }
}

}  // namespace
}  // namespace roadfix
