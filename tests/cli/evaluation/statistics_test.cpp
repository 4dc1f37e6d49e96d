#include "cli/evaluation/statistics.hpp"

#include <gtest/gtest.h>

namespace roadfix::evaluation {
namespace {

TEST(Mean, OfNothingIsNone) {
  EXPECT_EQ(mean({1.0, 2.0, 6.0}), 3.0);
  EXPECT_FALSE(mean({}));
}

TEST(Quantile, LiesBetweenTheOrderStatistics) {
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({1.0, 2.0}, 0.5), 1.5);
  EXPECT_EQ(quantile({5.0}, 0.95), 5.0);
  EXPECT_FALSE(quantile({}, 0.5));
}

}  // namespace
}  // namespace roadfix::evaluation
