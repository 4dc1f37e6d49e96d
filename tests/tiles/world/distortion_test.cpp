#include "tiles/world/distortion.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>

namespace roadfix::world {
namespace {

constexpr std::array<double, 2> kWavesM{200.0, 100.0};

TEST(Distortion, OfNoStrengthLeavesALineStraight) {
  Random random(1, 1);
  const Polyline line = Distortion(random, kWavesM, 0.0).bent({0, 0}, {30, 40}, 12.0);
  ASSERT_EQ(line.size(), 6U);
  EXPECT_EQ(line.front(), PlanPoint(0, 0));
  EXPECT_EQ(line[3], PlanPoint(18, 24));
  EXPECT_EQ(line.back(), PlanPoint(30, 40));
}

TEST(Distortion, MovesNoPointFartherThanItsWavesTogether) {
  Random random(1, 1);
  const Distortion bend(random, kWavesM, 0.05);
  double farthest = 0.0;
  for (double x = 0.0; x < 1000.0; x += 10.0) {
    farthest = std::max(farthest, cv::norm(bend({x, 500.0}) - PlanPoint(x, 500.0)));
  }
  EXPECT_GT(farthest, 1.0);
  EXPECT_LT(farthest, 300.0 * 1.15 * 0.05);
}

}  // namespace
}  // namespace roadfix::world
