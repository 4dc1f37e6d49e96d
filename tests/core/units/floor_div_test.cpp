#include "core/units/floor_div.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace roadfix {
namespace {

TEST(FloorDiv, RoundsDownOnBothSidesOfZero) {
  for (const int b : {1, 3, 4, 256}) {
    for (int a = -600; a <= 600; ++a)
      EXPECT_EQ(floor_div(a, b), std::floor(static_cast<double>(a) / b)) << a << " / " << b;
  }
}

TEST(FloorDiv, TakesTheSmallestAndTheLargestNumber) {
  EXPECT_EQ(floor_div(std::numeric_limits<int>::min(), 2), -(1 << 30));
  EXPECT_EQ(floor_div(std::numeric_limits<int>::max(), 2), (1 << 30) - 1);
}

}  // namespace
}  // namespace roadfix
