#include "cli/evaluation/intervals.hpp"

#include <gtest/gtest.h>

namespace roadfix::evaluation {
namespace {

// Brown, Cai, DasGupta 2001 and the closed forms at the ends: 1 - (alpha / 2)^(1 / n).
TEST(ClopperPearson, AgreesWithPublishedValues) {
  EXPECT_NEAR(clopper_pearson(0, 20).high, 0.16843, 1e-5);
  EXPECT_EQ(clopper_pearson(0, 20).low, 0.0);
  EXPECT_NEAR(clopper_pearson(20, 20).low, 1.0 - 0.16843, 1e-5);
  EXPECT_NEAR(clopper_pearson(5, 10).low, 0.18709, 1e-5);
  EXPECT_NEAR(clopper_pearson(5, 10).high, 0.81291, 1e-5);
}

TEST(ClopperPearson, OfNothingSaysNothing) {
  EXPECT_EQ(clopper_pearson(0, 0).low, 0.0);
  EXPECT_EQ(clopper_pearson(0, 0).high, 1.0);
}

TEST(ChiSquareBand, IsNotBelowZeroWhereItIsOfOneValue) {
  EXPECT_EQ(chi_square_mean_band(1, 1).low, 0.0);
  EXPECT_NEAR(chi_square_mean_band(1, 1).high, 5.02, 0.1);
}

TEST(ChiSquareBand, AgreesWithTables) {
  // chi^2 with 100 degrees: 74.222 at 2.5 %, 129.561 at 97.5 %.
  EXPECT_NEAR(chi_square_mean_band(50, 2).low, 74.222 / 50.0, 0.01);
  EXPECT_NEAR(chi_square_mean_band(50, 2).high, 129.561 / 50.0, 0.01);
}

}  // namespace
}  // namespace roadfix::evaluation
