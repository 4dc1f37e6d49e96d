#include "core/track/measurement_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/units/draws.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

/// Sums over binary cells, road in the map where `m`, in the feature map where `l`.
MatchSums sums_of(const std::vector<bool>& m, const std::vector<bool>& l) {
  MatchSums s;
  for (std::size_t i = 0; i < m.size(); ++i) s.add(m[i] ? 1.0 : 0.0, l[i] ? 1.0 : 0.0);
  return s;
}

struct Cells {
  std::vector<bool> m;
  std::vector<bool> l;
};

/// Each cell seen as road with probability `a` where there is one and `b` elsewhere.
Cells seen(std::mt19937_64& random, double a, double b) {
  Cells cells;
  for (int i = 0; i < 2000; ++i) {
    cells.m.push_back(uniform(random, 0, 1) < 0.2);
    cells.l.push_back(uniform(random, 0, 1) < (cells.m.back() ? a : b));
  }
  return cells;
}

TEST(MeasurementModel, TakesNoPatternFromGreyLevelsThatHardlyDiffer) {
  MatchSums alike;
  MatchSums unlike;
  for (int i = 0; i < 2000; ++i) {
    alike.add(i % 5 == 0 ? 1.0 : 0.0, i % 5 == 0 ? 1.0 / 254 : 0.0);
    unlike.add(i % 5 == 0 ? 1.0 : 0.0, i % 5 == 0 ? 0.0 : 1.0 / 254);
  }
  const MeasurementModel model;
  EXPECT_EQ(model.log_likelihood(alike, alike.n, 2.0), model.log_likelihood(unlike, unlike.n, 2.0));
}

TEST(MeasurementModel, IsForTheTruePlaceAndAgainstOthers) {
  std::mt19937_64 random(2);
  const MeasurementModel model;
  const Cells truth = seen(random, 0.5, 0.1);
  const Cells other = seen(random, 0.5, 0.1);
  // 2000 cells of 16 m: as many samples as a footprint of 700 m.
  EXPECT_GT(model.log_likelihood(sums_of(truth.m, truth.l), 2000, 16.0), 3.0);
  EXPECT_LT(model.log_likelihood(sums_of(other.m, truth.l), 2000, 16.0), -1.0);
}

TEST(MeasurementModel, ByCorrelationHasAMeanRatioOfOneByChance) {
  // Without tempering and useless frames, the ratio to chance averages to 1 over chance by its definition.
  MeasurementModel model;
  model.useless_share = 0.0;
  model.temper = 1.0;
  model.expected_correlation = 0.03;
  model.most_samples = std::numeric_limits<double>::infinity();
  std::mt19937_64 random(3);
  double sum = 0.0;
  constexpr int kRuns = 2000;
  for (int i = 0; i < kRuns; ++i) {
    const Cells a = seen(random, 0.5, 0.5);
    const MatchSums s = sums_of(a.m, a.l);
    sum += std::exp(model.log_likelihood(s, s.n, 15.0));  // each cell is a sample
  }
  // ratio = exp(x - v / 2) with x normal of variance v = 2000 * 0.03^2: its own spread is sqrt(e^v - 1) = 2.25.
  EXPECT_NEAR(sum / kRuns, 1.0, 5.0 * 2.25 / std::sqrt(kRuns));
}

TEST(MeasurementModel, SaysAsMuchOfTheSameGroundInSmallerCells) {
  std::mt19937_64 random(7);
  const Cells large = seen(random, 0.5, 0.1);
  MatchSums four_times;
  for (std::size_t i = 0; i < 4 * large.m.size(); ++i) {
    four_times.add(large.m[i / 4] ? 1.0 : 0.0, large.l[i / 4] ? 1.0 : 0.0);
  }
  const MeasurementModel model;
  EXPECT_NEAR(model.log_likelihood(four_times, 8000, 7.0), model.log_likelihood(sums_of(large.m, large.l), 2000, 14.0),
              1e-9);
}

TEST(MeasurementModel, SaysMoreOfMoreGroundButNeverMoreThanItsMostSamplesWould) {
  MeasurementModel model;
  model.useless_share = 0.0;
  MatchSums sums;
  double last = 0.0;
  for (int doublings = 0; doublings < 16; ++doublings) {
    for (std::int64_t cells = sums.n; cells < 100LL << doublings; cells += 5) {
      for (int i = 0; i < 5; ++i) sums.add(i == 0 ? 1.0 : 0.0, i == 0 ? 1.0 : 0.0);  // agrees wholly
    }
    const double said = model.log_likelihood(sums, sums.n, 15.0);
    EXPECT_GT(said, last);
    last = said;
  }
  // As many samples of correlation 1: the limit, of which 3.3 million cells lack a 20,000th.
  const double c = model.expected_correlation;
  EXPECT_NEAR(last, model.temper * c * (1.0 - 0.5 * c) * model.most_samples, 0.01);
}

TEST(MeasurementModel, FallsNoFurtherThanTheShareOfUselessFrames) {
  MeasurementModel model;
  std::mt19937_64 random(4);
  const Cells cells = seen(random, 0.0, 0.9);
  EXPECT_NEAR(model.log_likelihood(sums_of(cells.m, cells.l), 2000, 16.0), std::log(model.useless_share), 0.01);
}

TEST(MeasurementModel, SaysNothingWhereNothingWasObserved) {
  EXPECT_EQ(MeasurementModel{}.log_likelihood({}, 0, 2.0), 0.0);
  MeasurementModel paper;
  paper.kind = LikelihoodKind::kEquation7;
  EXPECT_EQ(paper.log_likelihood({}, 0, 2.0), -std::numeric_limits<double>::infinity());
}

TEST(MeasurementModel, OfAPoseThatIsMostlyOutsideTheMapIsNoBetterThanThatOfAWrongPlace) {
  std::mt19937_64 random(6);
  const Cells truth = seen(random, 0.5, 0.1);
  const Cells other = seen(random, 0.5, 0.1);
  const MeasurementModel model;
  const double wrong = model.log_likelihood(sums_of(other.m, truth.l), 2000, 16.0);
  EXPECT_NEAR(model.log_likelihood({}, 2000, 16.0), wrong, 0.5) << "nothing in common";
  // A tenth of the footprint on the map, and all that is seen there fits.
  const std::vector<bool> few(truth.m.begin(), truth.m.begin() + 200);
  EXPECT_LT(model.log_likelihood(sums_of(few, few), 2000, 16.0), 0.0);
  EXPECT_GT(model.log_likelihood(sums_of(few, few), 200, 16.0), 0.0);
}

TEST(MeasurementModel, SupportsABeliefThatExplainsWhatWasSeenBetterThanChance) {
  EXPECT_FALSE(MeasurementModel().supports(0.9));
  EXPECT_TRUE(MeasurementModel().supports(1.1));
}

TEST(MeasurementModel, OfEquation7IsItself) {
  std::mt19937_64 random(5);
  const Cells cells = seen(random, 0.6, 0.1);
  MeasurementModel paper;
  paper.kind = LikelihoodKind::kEquation7;
  const MatchSums s = sums_of(cells.m, cells.l);
  EXPECT_NEAR(std::exp(paper.log_likelihood(s, 2000, 2.0)), *rho(s), 1e-12);
}

}  // namespace
}  // namespace roadfix
