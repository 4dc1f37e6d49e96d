#include "core/match/scales.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadfix {
namespace {

TEST(Scales, WithoutARangeThereIsOne) {
  const Scales scales = Scales::for_footprint(300.0, 8.0, 0.0);
  EXPECT_EQ(scales.reach(), 0);
  EXPECT_EQ(scales.factor(0), 1.0);
  EXPECT_EQ(scales.finer(4).reach(), 0);
}

TEST(Scales, ReachFromTheSmallestToItsInverseInStepsOfACellAtTheEdge) {
  for (const double range : {0.01, 0.15, 0.3}) {
    const Scales scales = Scales::for_footprint(300.0, 8.0, range);
    const int reach = scales.reach();
    ASSERT_GE(reach, 1);
    EXPECT_NEAR(scales.factor(-reach), 1.0 - range, 1e-12);
    EXPECT_NEAR(scales.factor(reach), 1.0 / (1.0 - range), 1e-12);
    for (int i = -reach; i < 0; ++i) EXPECT_LE(300.0 * (scales.factor(i + 1) - scales.factor(i)), 8.0);
  }
}

TEST(Scales, TheNearestOfAFactorIsTheIndexThatHasIt) {
  const Scales scales = Scales::for_footprint(300.0, 8.0, 0.15);
  for (int index = -scales.reach(); index <= scales.reach(); ++index) {
    EXPECT_EQ(scales.nearest(std::log(scales.factor(index))), index);
  }
  EXPECT_EQ(scales.nearest(1.0), scales.reach()) << "beyond the range it is the last";
  EXPECT_EQ(scales.nearest(-1.0), -scales.reach());
  EXPECT_EQ(Scales().nearest(0.3), 0);
}

TEST(Scales, FinerStepsHoldTheCoarserOnes) {
  const Scales scales = Scales::for_footprint(300.0, 8.0, 0.15);
  const Scales finer = scales.finer(4);
  EXPECT_EQ(finer.reach(), 4 * scales.reach());
  EXPECT_DOUBLE_EQ(finer.factor(-4), scales.factor(-1));
}

}  // namespace
}  // namespace roadfix
