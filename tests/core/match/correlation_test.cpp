#include "core/match/correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace roadfix {
namespace {

MatchSums sums_of(const std::vector<double>& m, const std::vector<double>& l) {
  MatchSums s;
  for (std::size_t i = 0; i < m.size(); ++i) s.add(m[i], l[i]);
  return s;
}

TEST(Rho, IsEquation5WithTheCommonMean) {
  const std::vector<double> m{0.0, 1.0, 0.5, 0.25};
  const std::vector<double> l{0.0, 0.75, 1.0, 0.5};
  const double mean = 4.0 / 8.0;
  double ml = 0.0;
  double mm = 0.0;
  double ll = 0.0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    ml += (m[i] - mean) * (l[i] - mean);
    mm += (m[i] - mean) * (m[i] - mean);
    ll += (l[i] - mean) * (l[i] - mean);
  }
  EXPECT_NEAR(rho(sums_of(m, l)).value(), ml / std::sqrt(mm * ll), 1e-12);
}

TEST(Rho, OfEqualMapsIsOneAndOfOppositeOnesMinusOne) {
  EXPECT_NEAR(rho(sums_of({0, 1, 1, 0}, {0, 1, 1, 0})).value(), 1.0, 1e-12);
  EXPECT_NEAR(rho(sums_of({0, 1, 1, 0}, {1, 0, 0, 1})).value(), -1.0, 1e-12);
}

TEST(Rho, IsUndefinedWithoutCommonCellsAndAtTheCommonMean) {
  EXPECT_FALSE(rho(MatchSums{}));
  EXPECT_FALSE(rho(sums_of({0.5, 0.5}, {0.5, 0.5})));
}

TEST(Rho, OfConstantMapsApartFromTheCommonMeanIsDefined) {
  EXPECT_NEAR(rho(sums_of({1, 1}, {0, 0})).value(), -1.0, 1e-12);
}

TEST(Pearson, DoesNotChangeWithTheRateOfTheDetector) {
  const std::vector<double> m{0, 1, 1, 0, 0, 1};
  const std::vector<double> l{0.0, 0.5, 0.5, 0.0, 0.5, 0.5};
  std::vector<double> weaker = l;
  for (double& v : weaker) v *= 0.2;
  EXPECT_NEAR(pearson(sums_of(m, l)).value(), pearson(sums_of(m, weaker)).value(), 1e-12);
  EXPECT_FALSE(pearson(sums_of({1, 1}, {0, 1})));
}

TEST(Likelihood, IsRhoButNeverNegative) {
  EXPECT_EQ(likelihood(0.25), 0.25);
  EXPECT_EQ(likelihood(-0.25), 0.0);
}

}  // namespace
}  // namespace roadfix
