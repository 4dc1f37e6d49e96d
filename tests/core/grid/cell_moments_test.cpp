#include "core/grid/cell_moments.hpp"

#include <gtest/gtest.h>

#include "tests/support/ascii_map.hpp"

namespace roadfix {
namespace {

TEST(CellMoments, LeaveUnobservedCellsOut) {
  const CellMoments moments = moments_of(testing::from_ascii("#..# ?.?#"));
  EXPECT_EQ(moments.count, 6);
  EXPECT_DOUBLE_EQ(moments.mean(), 0.5);
  EXPECT_DOUBLE_EQ(moments.variance(), 0.25);
  EXPECT_DOUBLE_EQ(moments.squared_deviations(), 1.5);
}

TEST(CellMoments, AreZeroWhereNothingIsObserved) {
  const CellMoments moments = moments_of(CellArray(3, 2));
  EXPECT_EQ(moments.mean(), 0.0);
  EXPECT_EQ(moments.variance(), 0.0);
  EXPECT_EQ(moments.squared_deviations(), 0.0);
}

}  // namespace
}  // namespace roadfix
