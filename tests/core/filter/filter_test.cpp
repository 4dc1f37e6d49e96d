#include "core/filter/filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "core/filter/clusters.hpp"
#include "tests/core/filter/square.hpp"

namespace roadfix {
namespace {

using testing::kSquare;
using testing::seen_at;
using testing::start_at;

struct Moments {
  GridPoint mean;
  double variance_east = 0.0;
};

Moments moments(const Particles& p) {
  Moments m;
  for (std::size_t i = 0; i < p.size(); ++i) {
    m.mean.east_m += p.weight[i] * p.east_m[i];
    m.mean.north_m += p.weight[i] * p.north_m[i];
  }
  for (std::size_t i = 0; i < p.size(); ++i) m.variance_east += p.weight[i] * std::pow(p.east_m[i] - m.mean.east_m, 2);
  return m;
}

TEST(Filter, DrawsParticlesAroundAProposalAsItsCovarianceSays) {
  FilterOptions options;
  options.max_particles = 40'000;
  Filter filter(options, {kSquare}, 7);
  const PoseCovariance told{{{25.0, -12.0, 0.02}, {-12.0, 16.0, -0.1}, {0.02, -0.1, 0.01}}};
  const GridPose mean{{500.0, 400.0}, Angle::degrees(30.0)};
  start_at(filter, {mean, told, 1.0});
  const Particles& p = filter.particles();
  PoseCovariance drawn{};
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::array<double, 3> off{p.east_m[i] - mean.position.east_m, p.north_m[i] - mean.position.north_m,
                                    p.heading_rad[i] - mean.heading.radians()};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) drawn[a][b] += off[a] * off[b] / options.max_particles;
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      // Five times the sampling error of a covariance.
      const double error = std::sqrt((told[a][a] * told[b][b] + told[a][b] * told[a][b]) / options.max_particles);
      EXPECT_NEAR(drawn[a][b], told[a][b], 5.0 * error) << a << ", " << b;
    }
  }
}

TEST(Filter, DrawsAsManyParticlesAroundEachProposalAsItsWeightSays) {
  Filter filter({}, {kSquare}, 7);
  std::vector<Proposal> proposals;
  for (const double weight : {0.3, 0.1, 0.2}) {
    const double at_m = 200.0 * static_cast<double>(proposals.size() + 1);
    proposals.push_back({{{at_m, at_m}, Angle()}, {}, weight});
  }
  filter.start_anew_from(proposals, 0.0, kSquare);
  const std::vector<double>& drawn = filter.particles().east_m;
  const auto count = static_cast<double>(drawn.size());
  for (const Proposal& proposal : proposals) {
    const double share = proposal.weight / 0.6;
    EXPECT_NEAR(static_cast<double>(std::ranges::count(drawn, proposal.mean.position.east_m)) / count, share,
                5.0 * std::sqrt(share * (1.0 - share) / count))
        << proposal.weight;
  }
}

TEST(Filter, DrawsAllParticlesOfACircleWithinIt) {
  PoseRegion circle = kSquare;
  circle.circle = GridCircle{{300.0, 500.0}, 80.0};
  Filter filter({}, {kSquare}, 7);
  filter.start_uniformly(circle);
  const Particles& p = filter.particles();
  double mean_square = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double off_m = distance_m({p.east_m[i], p.north_m[i]}, circle.circle->centre);
    ASSERT_LE(off_m, 80.0);
    mean_square += off_m * off_m / static_cast<double>(p.size());
  }
  EXPECT_NEAR(mean_square, 80.0 * 80.0 / 2.0, 100.0) << "as far out as a uniform density lies";
}

TEST(Filter, FindsTheCircleOfALargeBoxHoweverSmallItIs) {
  PoseRegion circle{{{0.0, 0.0}, {1e6, 1e6}}, GridCircle{{300.0, 500.0}, 1.0}, Angle(), Angle()};
  Filter filter({}, {circle}, 7);
  filter.start_uniformly(circle);
  EXPECT_LE(std::abs(*std::ranges::max_element(filter.particles().east_m) - 300.0), 1.0);
}

TEST(Filter, DrawsHeadingsOfAllTheRangeThatIsTold) {
  PoseRegion half = kSquare;
  half.heading = Angle::radians(1.0);
  half.heading_half_width = Angle::radians(0.5);
  Filter filter({}, {kSquare}, 7);
  filter.start_uniformly(half);
  const std::vector<double>& headings = filter.particles().heading_rad;
  EXPECT_NEAR(*std::ranges::min_element(headings), 0.5, 0.001);
  EXPECT_NEAR(*std::ranges::max_element(headings), 1.5, 0.001);
}

TEST(Filter, MovesCopiesOfAParticleApartAndLeavesWhatWasDrawnOnce) {
  FilterOptions options;
  options.adapts_count = false;
  options.effective_share = 1.0;
  options.injected_share = 0.0;
  AcceptanceRegion region{kSquare};
  region.max_log_scale = 0.01;
  Filter filter(options, region, 7);
  filter.start_uniformly(kSquare);
  const Particles before = filter.particles();
  ASSERT_TRUE(filter.correct(std::vector<double>(before.size(), 0.0)).resampled);
  EXPECT_EQ(filter.particles(), before) << "each was drawn once";
  std::vector<double> only_the_third(before.size(), -1000.0);
  only_the_third[2] = 0.0;
  ASSERT_TRUE(filter.correct(only_the_third).resampled);
  const Particles& copies = filter.particles();
  EXPECT_EQ(copies.east_m[0], before.east_m[2]);
  for (std::size_t i = 1; i < copies.size(); ++i) {
    ASSERT_NE(copies.east_m[i], before.east_m[2]);
    ASSERT_NE(copies.north_m[i], before.north_m[2]);
    ASSERT_NE(copies.heading_rad[i], before.heading_rad[2]);
    ASSERT_NE(copies.log_scale[i], before.log_scale[2]);
    ASSERT_LE(std::abs(copies.log_scale[i]), region.max_log_scale);
  }
  EXPECT_NEAR(distance_m({copies.east_m[1], copies.north_m[1]}, {before.east_m[2], before.north_m[2]}), 0.0,
              6.0 * options.roughening_m);
}

TEST(Filter, KeepsFiniteAveragesOfTheLargestLikelihood) {
  Filter filter(FilterOptions(), {kSquare}, 7);
  filter.start_uniformly(kSquare);
  const Correction correction = filter.correct(std::vector<double>(filter.particles().size(), kMaxLogLikelihood));
  EXPECT_TRUE(correction.usable && std::isfinite(correction.mean_likelihood));
  EXPECT_GT(filter.state().fast_fit, 0.5);
  EXPECT_EQ(filter.doubt(), 0.0);
}

TEST(Filter, AgreesWithTheKalmanFilterWhereAllIsNormal) {
  FilterOptions options;
  options.max_particles = options.min_particles = 20'000;
  options.injection = Injection::kLikelihoodAverages;
  options.injected_share = 0.0;
  options.roughening_m = 0.0;
  Filter filter(options, {kSquare}, 11);
  start_at(filter, {{{300.0, 400.0}, Angle()}, {{{100.0, 0, 0}, {0, 100.0, 0}, {0, 0, 0}}}, 1.0});
  double mean = 300.0;
  double variance = 100.0;
  for (int step = 0; step < 10; ++step) {
    // Heading north: 5 m to the right is 5 m east.
    filter.predict(OdometryMotion({20.0, 5.0, Angle()}, {{{4.0, 0, 0}, {0, 9.0, 0}, {0, 0, 0}}}));
    mean += 5.0;
    variance += 9.0;
    const double seen_east = 308.0 + 5.0 * step;
    filter.correct(seen_at(filter.particles(), {seen_east, 421.0 + 20.0 * step}, 8.0));
    const double gain = variance / (variance + 64.0);
    mean += gain * (seen_east - mean);
    variance *= 1.0 - gain;
    const Moments m = moments(filter.particles());
    EXPECT_NEAR(m.mean.east_m, mean, 0.3) << "step " << step;
    EXPECT_NEAR(m.variance_east, variance, 0.08 * variance) << "step " << step;
  }
}

TEST(Filter, ThePapersDrawsFifteenPercentUniformlyInEveryStepAndKeepsItsNumber) {
  Filter filter(FilterOptions::paper(2000), {kSquare}, 3);
  start_at(filter, {{{10.0, 10.0}, Angle()}, {}, 1.0});
  filter.predict(PlanarMotion{{0.0, 0.0}, {0.0, 0.0}, 1.0});
  const auto moved_away = [&] {
    const Particles& p = filter.particles();
    int count = 0;
    for (std::size_t i = 0; i < p.size(); ++i) count += p.east_m[i] != 10.0 ? 1 : 0;
    return count;
  };
  EXPECT_EQ(moved_away(), 300);
  EXPECT_EQ(filter.particles().size(), 2000U);
  EXPECT_TRUE(filter.correct(std::vector<double>(2000, 0.0)).resampled);
}

TEST(Filter, GivesTheSameParticlesFromTheSameSeedWithAnyNumberOfThreads) {
  const auto run = [](std::uint64_t seed, int threads) {
    Filter filter({}, {kSquare}, seed, threads);
    filter.start_uniformly(kSquare);
    for (int step = 0; step < 5; ++step) {
      filter.predict(PlanarMotion{{20.0, 2.0}, {0.0, 0.05}, 1.0, 0.1});
      filter.correct(seen_at(filter.particles(), {500.0, 300.0 + 20.0 * step}, 30.0));
    }
    return filter.state();
  };
  EXPECT_EQ(run(1, 1), run(1, 4));
  EXPECT_NE(run(1, 1), run(2, 1));
}

TEST(Filter, NeedsFewerParticlesOnceItKnowsWhereItIs) {
  Filter filter({}, {kSquare}, 1);
  filter.start_uniformly(kSquare);
  EXPECT_EQ(filter.particles().size(), 10'000U);
  for (int step = 0; step < 5; ++step) {
    filter.predict(PlanarMotion{{0.0, 0.5}, {0.0, 0.01}, 1.0});
    filter.correct(seen_at(filter.particles(), {500.0, 300.0}, 15.0));
  }
  EXPECT_EQ(filter.particles().size(), 1'000U);
}

TEST(Filter, KeepsParticlesBeyondTheRegionAsFarAsItSaysAndDrawsNoneThere) {
  FilterOptions options = FilterOptions::paper(4000);
  options.injected_share = 0.5;
  Filter filter(options, {kSquare, 200.0}, 5);
  const auto beyond = [&](double north_m) {
    return std::ranges::count_if(filter.particles().north_m, [&](double n) { return n > north_m; });
  };
  filter.start_uniformly(kSquare);
  EXPECT_EQ(beyond(1000.0), 0);
  const OdometryMotion ahead({150.0, 0.0, Angle()}, {});
  // In particles of every heading, a share of about 150 / (1000 pi) crosses a side of the square.
  filter.predict(ahead);
  EXPECT_NEAR(static_cast<double>(beyond(1000.0)), 191.0, 5.0 * std::sqrt(191.0));
  for (std::size_t i = 0; i < filter.particles().size(); ++i) {
    EXPECT_GT(filter.particles().weight[i], 0.0) << "150 m are fewer than 200";
  }
  filter.predict(ahead);
  double weight = 0.0;
  for (std::size_t i = 0; i < filter.particles().size(); ++i) {
    if (filter.particles().north_m[i] > 1200.0) weight += filter.particles().weight[i];
  }
  EXPECT_GT(beyond(1200.0), 0);
  EXPECT_EQ(weight, 0.0);
}

TEST(Filter, TakesParticlesThatLeaveTheRegionOutOfTheBelief) {
  Filter filter({}, {kSquare}, 1);
  start_at(filter, {{{990.0, 500.0}, Angle::degrees(90.0)}, {{{100.0, 0, 0}, {0, 1, 0}, {0, 0, 0}}}, 1.0});
  EXPECT_NEAR(filter.predict(OdometryMotion({5.0, 0.0, Angle()}, {})), 0.69, 0.03) << "of a normal below 0.5 sigma";
  double within = 0.0;
  const Particles& p = filter.particles();
  for (std::size_t i = 0; i < p.size(); ++i) within += p.east_m[i] <= 1000.0 ? p.weight[i] : 0.0;
  EXPECT_NEAR(within, 1.0, 1e-9);
}

TEST(Filter, BeginsAnewWhereMostParticlesLeaveTheRegionAndTakesNoneThatLagBehindForABelief) {
  for (const double way_m : {15.0, 5000.0}) {
    Filter filter({}, {kSquare}, 1);
    start_at(filter, {{{990.0, 500.0}, Angle::degrees(90.0)}, {{{100.0, 0, 0}, {0, 1, 0}, {0, 0, 0}}}, 1.0});
    EXPECT_EQ(filter.predict(OdometryMotion({way_m, 0.0, Angle()}, {})), 0.0) << way_m;
    EXPECT_EQ(filter.state().resets, 1U) << way_m;
    EXPECT_NEAR(moments(filter.particles()).mean.east_m, 500.0, 20.0) << way_m;
  }
}

TEST(Filter, ThePapersGoesOnWithTheParticlesThatDoNotLeaveTheRegion) {
  Filter filter(FilterOptions::paper(2000), {kSquare}, 1);
  start_at(filter, {{{990.0, 500.0}, Angle::degrees(90.0)}, {{{100.0, 0, 0}, {0, 1, 0}, {0, 0, 0}}}, 1.0});
  // Of the 85 % around the place those within, beyond 0.5 sigma; of those drawn uniformly in this step nearly all.
  EXPECT_NEAR(filter.predict(OdometryMotion({15.0, 0.0, Angle()}, {})), 0.85 * 0.31 + 0.15 * 0.99, 0.04);
  EXPECT_EQ(filter.state().resets, 0U);
  filter.predict(OdometryMotion({5000.0, 0.0, Angle()}, {}));
  EXPECT_EQ(filter.state().resets, 1U) << "where none stays";
}

TEST(Filter, KeepsItsBeliefWhereNothingCouldExplainTheMeasurement) {
  Filter filter({}, {kSquare}, 1);
  filter.start_uniformly(kSquare);
  const FilterState before = filter.state();
  const std::vector<double> impossible(before.particles.size(), -std::numeric_limits<double>::infinity());
  EXPECT_FALSE(filter.correct(impossible).usable);
  EXPECT_EQ(filter.state(), before);
}

TEST(Filter, DoubtsItsBeliefAfterMeasurementsThatFitWorseAndDrawsElsewhere) {
  Filter filter({}, {kSquare}, 1);
  start_at(filter, {{{300.0, 300.0}, Angle()}, {{{25.0, 0, 0}, {0, 25.0, 0}, {0, 0, 0.01}}}, 1.0});
  const auto feed = [&](double log_ratio, int steps) {
    for (int i = 0; i < steps; ++i) {
      filter.predict(PlanarMotion{{0.0, 0.1}, {0.0, 0.01}, 1.0});
      filter.correct(std::vector<double>(filter.particles().size(), log_ratio));
    }
  };
  feed(4.0, 60);
  EXPECT_LT(filter.doubt(), 0.05);
  EXPECT_EQ(clusters_of(filter.particles()).size(), 1U);
  feed(-3.0, 15);
  EXPECT_GT(filter.doubt(), 0.3);
  EXPECT_GT(clusters_of(filter.particles()).size(), 20U);
  filter.start_uniformly(kSquare);
  EXPECT_EQ(filter.doubt(), 0.0) << "a belief that begins has no past";
}

TEST(Filter, DrawsNothingElsewhereForMeasurementsThatFitNowBetterAndNowWorse) {
  Filter filter({}, {kSquare}, 1);
  start_at(filter, {{{300.0, 300.0}, Angle()}, {{{25.0, 0, 0}, {0, 25.0, 0}, {0, 0, 0.01}}}, 1.0});
  for (int i = 0; i < 100; ++i) {
    filter.predict(PlanarMotion{{0.0, 0.1}, {0.0, 0.01}, 1.0});
    filter.correct(std::vector<double>(filter.particles().size(), i % 2 == 0 ? 1.0 : -0.5));
    ASSERT_LT(filter.doubt(), 0.15) << "step " << i;
  }
  EXPECT_EQ(clusters_of(filter.particles()).size(), 1U);
}

TEST(Filter, InjectsProposalsOfASearch) {
  Filter filter({}, {kSquare}, 1);
  start_at(filter, {{{300.0, 300.0}, Angle()}, {}, 1.0});
  const Proposal there{{{800.0, 700.0}, Angle::degrees(45.0)}, {{{4.0, 0, 0}, {0, 4.0, 0}, {0, 0, 1e-4}}}, 1.0};
  filter.inject(std::span(&there, 1), 0.25);
  const auto clusters = clusters_of(filter.particles());
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_NEAR(clusters[1].weight, 0.25, 1e-9);
  EXPECT_NEAR(clusters[1].mean.position.east_m, 800.0, 1.0);
}

/// About 0.
double sigma_of(const std::vector<double>& values) {
  double sum2 = 0.0;
  for (const double v : values) sum2 += v * v;
  return std::sqrt(sum2 / static_cast<double>(values.size()));
}

TEST(Filter, DrawsScaleAndDriftOfNewParticlesAndKeepsTheScaleWithinItsRange) {
  FilterOptions options;
  options.injected_share = 0.0;
  Filter filter(options, {kSquare, 0.0, 0.1, 4.0}, 5);
  const Particles& p = filter.particles();
  // Of 10,000 draws a standard deviation is known to 0.7 %; five times that is allowed.
  filter.start_uniformly(kSquare);
  EXPECT_NEAR(sigma_of(p.log_scale), 0.1 / std::sqrt(3.0), 0.002);
  EXPECT_NEAR(sigma_of(p.drift_north_m_s), 4.0, 0.14);
  start_at(filter, {{{300.0, 300.0}, Angle()}, {}, 1.0, 0.09, 0.02});
  EXPECT_NEAR(sigma_of(p.drift_east_m_s), 4.0, 0.14);
  for (int step = 0; step < 5; ++step) {
    EXPECT_NEAR(*std::ranges::max_element(p.log_scale), 0.1, 1e-12);
    EXPECT_GT(*std::ranges::min_element(p.log_scale), -0.02);
    filter.predict(PlanarMotion{{0.0, 0.0}, {0.0, 0.0}, 1.0});
    EXPECT_TRUE(filter.correct(seen_at(p, {300.0, 300.0}, 3.0)).usable);
  }
}

TEST(Filter, SpreadsItsBeliefByAsMuchAsItIsTold) {
  Filter filter({}, {kSquare}, 5);
  start_at(filter, {{{0.0, 0.0}, Angle()}, {}, 1.0});
  filter.widen(4.0);
  EXPECT_NEAR(sigma_of(filter.particles().east_m), 4.0, 0.14);
  EXPECT_NEAR(sigma_of(filter.particles().north_m), 4.0, 0.14);
}

TEST(Filter, WidensTheDriftOfItsParticlesAndDrawsNewOnesWithAsMuch) {
  Filter filter({}, {kSquare}, 5);
  const Particles& p = filter.particles();
  filter.start_uniformly(kSquare);
  ASSERT_EQ(sigma_of(p.drift_east_m_s), 0.0);
  filter.widen_drift(3.0);
  EXPECT_NEAR(sigma_of(p.drift_east_m_s), 3.0, 0.11);
  filter.widen_drift(4.0);
  EXPECT_NEAR(sigma_of(p.drift_north_m_s), 5.0, 0.18) << "to what they had";
  filter.start_uniformly(kSquare);
  EXPECT_NEAR(sigma_of(p.drift_north_m_s), 4.0, 0.14);
}

TEST(Filter, TriesDriftsOfAShareOfItsParticlesAndLeavesTheOthers) {
  Filter filter({}, {kSquare}, 5);  // 10,000 particles
  const Particles& p = filter.particles();
  filter.start_uniformly(kSquare);
  filter.try_drifts(0.1, 3.0);
  std::vector<double> tried;
  std::ranges::copy_if(p.drift_east_m_s, std::back_inserter(tried), [](double drift) { return drift != 0.0; });
  EXPECT_NEAR(static_cast<double>(tried.size()), 1'000.0, 4.0 * std::sqrt(900.0));
  EXPECT_NEAR(sigma_of(tried), 3.0, 4.0 * 3.0 / std::sqrt(2.0 * 1'000.0));
  filter.start_uniformly(kSquare);
  EXPECT_EQ(sigma_of(p.drift_east_m_s), 0.0) << "new ones have none";
}

}  // namespace
}  // namespace roadfix
