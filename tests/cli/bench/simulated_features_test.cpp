#include "cli/bench/simulated_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace roadfix::bench {
namespace {

/// Streets 8 m wide every 100 m, at 2 m cells.
RoadGrid street_grid() {
  RoadGrid map{{2.0, {0, 0}, 400, 400}, CellArray(400, 400, kNoRoad)};
  for (int row = 0; row < 400; ++row) {
    for (int col = 0; col < 400; ++col) {
      if (row % 50 < 4 || col % 50 < 4) map.cells.at(col, row) = kRoad;
    }
  }
  return map;
}

std::ptrdiff_t roads(const FeatureMap& map) {
  return std::ranges::count_if(map.cells.cells(), [](Cell cell) { return is_observed(cell) && cell > 127; });
}

const GridPose kPose{{400.0, -400.0}, Angle::degrees(0)};

TEST(SimulateFeatures, WithoutNoiseReturnsTheMap) {
  Random random = stream(1, 0, 0);
  const FeatureMap features = simulate_features(street_grid(), kPose, {200, 200}, {}, random);
  EXPECT_EQ(features.cells.cols(), 100);
  EXPECT_EQ(features.cells.observed_count(), 10000u);
  EXPECT_EQ(roads(features), 100 * 100 - 92 * 92);
}

TEST(SimulateFeatures, EraseAndInventTheirShares) {
  Random random = stream(1, 0, 0);
  const auto all = static_cast<double>(roads(simulate_features(street_grid(), kPose, {400, 400}, {}, random)));
  const auto kept =
      static_cast<double>(roads(simulate_features(street_grid(), kPose, {400, 400}, {.erase = 0.3}, random)));
  EXPECT_NEAR(kept / all, 0.7, 0.05);  // the last patch overshoots by at most its area
  const auto more =
      static_cast<double>(roads(simulate_features(street_grid(), kPose, {400, 400}, {.invent = 0.5}, random)));
  EXPECT_NEAR(more / all, 1.5, 0.05);
}

TEST(SimulateFeatures, EqualStreamsGiveEqualFeatures) {
  Random first = stream(3, 1, 4);
  Random second = stream(3, 1, 4);
  const FeatureNoise noise{0.2, 0.2, 5.0};
  EXPECT_EQ(simulate_features(street_grid(), kPose, {200, 200}, noise, first).cells,
            simulate_features(street_grid(), kPose, {200, 200}, noise, second).cells);
}

}  // namespace
}  // namespace roadfix::bench
