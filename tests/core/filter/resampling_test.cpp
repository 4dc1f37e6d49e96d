#include "core/filter/resampling.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "core/filter/random.hpp"

namespace roadfix {
namespace {

using ::testing::ElementsAre;

TEST(EffectiveSampleSize, IsTheNumberOfEqualWeightsAndOneForASingleOne) {
  EXPECT_DOUBLE_EQ(effective_sample_size(std::vector<double>(50, 0.02)), 50.0);
  EXPECT_DOUBLE_EQ(effective_sample_size(std::vector{0.0, 1.0, 0.0}), 1.0);
}

TEST(SystematicResampling, DrawsEachParticleFloorOrCeilOfItsShare) {
  RandomStream random(Draw::kStart, {3, 0, 0});
  std::vector<double> weights(97);
  for (double& w : weights) w = std::pow(random.uniform(), 4.0);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& w : weights) w /= sum;
  for (const std::size_t count : {1U, 10U, 97U, 1000U}) {
    for (const double offset : {0.0, 0.37, 0.999}) {
      const auto ancestors = systematic_ancestors(weights, count, offset);
      ASSERT_EQ(ancestors.size(), count);
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const auto drawn = static_cast<double>(std::ranges::count(ancestors, i));
        EXPECT_LT(std::abs(drawn - static_cast<double>(count) * weights[i]), 1.0) << "particle " << i;
      }
    }
  }
}

TEST(SystematicResampling, NeverDrawsWhatHasNoWeight) {
  EXPECT_THAT(systematic_ancestors(std::vector{0.0, 0.5, 0.0, 0.5, 0.0}, 4, 0.0), ElementsAre(1, 1, 3, 3));
  EXPECT_THAT(systematic_ancestors(std::vector{0.0, 1.0}, 2, 0.999), ElementsAre(1, 1));
}

TEST(SystematicResampling, DrawsTheLastOneWhereWeightsRoundToASumBelowOne) {
  EXPECT_THAT(systematic_ancestors(std::vector{0.5, 0.49999}, 2, 0.99999), ElementsAre(0, 1));
}

TEST(KldSampling, AsksForTheChiSquareQuantileOfItsBins) {
  // n = chi2(k - 1, 0.99) / (2 * 0.05); quantiles of the chi-square distribution from tables. The Wilson-Hilferty
  // approximation is good to a few in a thousand from ten degrees of freedom on.
  EXPECT_NEAR(kld_sample_count(11), 23.209 / 0.1, 0.3);
  EXPECT_NEAR(kld_sample_count(101), 135.807 / 0.1, 0.5);
  EXPECT_EQ(kld_sample_count(1), 1.0);
}

TEST(KldSampling, CountsBinsOfChosenParticlesOnce) {
  Particles p;
  p.resize(7);
  p.set(0, {1.0, 1.0, 0.01});
  p.set(1, {19.0, 19.0, 0.1});
  p.set(2, {21.0, 1.0, 0.01});
  p.set(3, {1.0, 1.0, 1.0});
  EXPECT_EQ(occupied_bins(p, std::vector<std::size_t>{0, 0, 1, 1}), 1U);
  EXPECT_EQ(occupied_bins(p, std::vector<std::size_t>{0, 1, 2, 3}), 3U);
  p.set(4, {1.0, 1.0, 0.18, 0.0, 0.0, 0.04});
  p.set(5, {1.0, 1.0, 0.01, 0.0, 0.0, 0.04});
  p.set(6, {1.0, 1.0, 0.01, 0.0, 0.0, 0.06});
  EXPECT_EQ(occupied_bins(p, std::vector<std::size_t>{0, 4}), 2U) << "of 10 degrees";
  EXPECT_EQ(occupied_bins(p, std::vector<std::size_t>{0, 5}), 1U);
  EXPECT_EQ(occupied_bins(p, std::vector<std::size_t>{0, 6}), 2U) << "of a twentieth of the scale";
}

}  // namespace
}  // namespace roadfix
