#include "core/units/draws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace roadfix {
namespace {

constexpr std::uint64_t kAllOnes = std::numeric_limits<std::uint64_t>::max();

TEST(UnitInterval, HoldsItsLowerEndAndNotItsUpper) {
  EXPECT_EQ(unit_interval(0), 0.0);
  EXPECT_EQ(unit_interval(kAllOnes), 1.0 - 0x1.0p-53);
  EXPECT_EQ(unit_interval(std::uint64_t{1} << 63U), 0.5);
}

TEST(Uniform, CoversTheRangeFromItsLowerEnd) {
  const auto lowest = [] { return std::uint64_t{0}; };
  const auto half = [] { return std::uint64_t{1} << 63U; };
  EXPECT_EQ(uniform(lowest, -3.0, 5.0), -3.0);
  EXPECT_EQ(uniform(half, -3.0, 5.0), 1.0);
}

TEST(NormalPair, IsFiniteForEveryNumberThatIsDrawn) {
  for (const double u : {0.0, 0.5, unit_interval(kAllOnes)}) {
    const auto [a, b] = normal_pair(u, u);
    EXPECT_TRUE(std::isfinite(a) && std::isfinite(b)) << u;
  }
}

TEST(NormalPair, HasTheMomentsOfTwoIndependentStandardNormalNumbers) {
  constexpr int kCount = 100'000;
  std::mt19937_64 random(1);
  double sum = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  double product = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const auto [a, b] = normal_pair(random);
    sum += a + b;
    squares += a * a + b * b;
    fourths += a * a * a * a + b * b * b * b;
    product += a * b;
  }
  EXPECT_NEAR(sum / (2.0 * kCount), 0.0, 0.01);
  EXPECT_NEAR(squares / (2.0 * kCount), 1.0, 0.015);
  EXPECT_NEAR(fourths / (2.0 * kCount), 3.0, 0.11);
  EXPECT_NEAR(product / kCount, 0.0, 0.015);
}

}  // namespace
}  // namespace roadfix
