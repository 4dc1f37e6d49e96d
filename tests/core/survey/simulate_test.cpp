#include "core/survey/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/grid/resample.hpp"

namespace roadfix {
namespace {

/// Streets 8 m wide every 100 m, at 2 m cells.
RoadGrid street_grid() {
  RoadGrid map{{2.0, {0, 0}, 600, 600}, CellArray(600, 600, kNoRoad)};
  for (int row = 0; row < 600; ++row) {
    for (int col = 0; col < 600; ++col) {
      if (row % 50 < 4 || col % 50 < 4) map.cells.at(col, row) = kRoad;
    }
  }
  return map;
}

const GridPose kPose{{600.0, -600.0}, Angle::degrees(0)};

FeatureMap simulated(int side, const FeatureQuality& quality, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  return simulate_features(street_grid(), kPose, side, side, quality, random);
}

std::ptrdiff_t roads(const FeatureMap& map) {
  return std::ranges::count_if(map.cells.cells(), [](Cell cell) { return is_observed(cell) && cell > 127; });
}

TEST(SimulateFeatures, OfPerfectQualityAreTheMap) {
  const FeatureMap features = simulated(100, {});
  EXPECT_EQ(features.cells.cols(), 100);
  EXPECT_EQ(features.cells.observed_count(), 10000u);
  EXPECT_EQ(roads(features), 100 * 100 - 92 * 92);
}

TEST(SimulateFeatures, EraseAndInventTheirShares) {
  const auto all = static_cast<double>(roads(simulated(200, {})));
  const auto kept = static_cast<double>(roads(simulated(200, {.erase = 0.3})));
  EXPECT_NEAR(kept / all, 0.7, 0.05);  // the last patch overshoots by at most its area
  const auto more = static_cast<double>(roads(simulated(200, {.invent = 0.5})));
  EXPECT_NEAR(more / all, 1.5, 0.05);
}

TEST(SimulateFeatures, AreWrongInTheWordsOfTheMap) {
  constexpr Cell kHardly = 5;
  constexpr Cell kLikely = 236;
  RoadGrid map = street_grid();
  for (Cell& cell : map.cells.cells()) cell = cell == kRoad ? kLikely : kHardly;
  std::mt19937_64 random(3);
  const FeatureMap features = simulate_features(map, kPose, 150, 150, {.erase = 0.4, .invent = 0.4}, random);
  EXPECT_TRUE(
      std::ranges::all_of(features.cells.cells(), [](Cell cell) { return cell == kHardly || cell == kLikely; }));
}

TEST(SimulateFeatures, HideAShareOfTheGround) {
  // The last disc, of at most a fifth of the side, may hide pi / 25 more.
  const double hidden = 1.0 - static_cast<double>(simulated(200, {.block = 0.3}).cells.observed_count()) / 40'000.0;
  EXPECT_GE(hidden, 0.3);
  EXPECT_LT(hidden, 0.43);
}

TEST(SimulateFeatures, OfAnotherScaleSpreadTheStreets) {
  // A street of the map 200 m ahead: where is it in the feature map? Its distance tells the scale that was drawn.
  double square_sum = 0.0;
  constexpr int kDraws = 60;
  constexpr double kSigma = 0.02;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const FeatureMap features = simulated(280, {.scale = kSigma}, seed);
    // Row of the street's middle by the centre of its mass, away from crossings, near row 140 - 100 + 2.
    double mass = 0.0;
    double moment = 0.0;
    for (int row = 25; row < 60; ++row) {
      const Cell cell = features.cells.at(120, row);
      mass += probability(cell);
      moment += probability(cell) * (row + 0.5);
    }
    const double ahead = 140.0 - moment / mass;
    square_sum += std::pow(98.0 / ahead - 1.0, 2);
  }
  // chi^2 of 60 draws lies within 0.6 and 1.5 of its mean but for one case in a thousand.
  EXPECT_GT(square_sum / kDraws, 0.6 * kSigma * kSigma);
  EXPECT_LT(square_sum / kDraws, 1.5 * kSigma * kSigma);
}

TEST(SimulateFeatures, UnderATiltKeepTheNadirAndBendTheRim) {
  const FeatureMap level = simulated(240, {});
  const FeatureMap tilted = simulated(240, {.tilt_deg = 3.0}, 5);
  std::ptrdiff_t middle = 0;
  std::ptrdiff_t rim = 0;
  for (int row = 0; row < 240; ++row) {
    for (int col = 0; col < 240; ++col) {
      const bool near = std::hypot(col - 120, row - 120) < 30;
      const bool differs = std::abs(level.cells.at(col, row) - tilted.cells.at(col, row)) > 127;
      (near ? middle : rim) += differs ? 1 : 0;
    }
  }
  EXPECT_EQ(middle, 0);
  EXPECT_GT(rim, 100);
}

TEST(SimulateFeatures, ShiftByTheStatedSpread) {
  // Streets of 4 cells every 50: the middle cell's street moves by the shift, along rows and columns.
  double square_sum = 0.0;
  constexpr int kDraws = 60;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const FeatureMap features = simulated(40, {.shift_m = 4.0}, seed);
    double mass = 0.0;
    double moment = 0.0;
    for (int row = 0; row < 40; ++row) {
      const double road = probability(features.cells.at(2, row));
      mass += road;
      moment += road * (row + 0.5);
    }
    square_sum += std::pow(2.0 * (moment / mass - 22.0), 2);
  }
  EXPECT_GT(square_sum / kDraws, 0.5 * 16.0);
  EXPECT_LT(square_sum / kDraws, 1.6 * 16.0);
}

TEST(SimulateFeatures, EqualGeneratorsGiveEqualFeatures) {
  const FeatureQuality quality{
      .erase = 0.2, .invent = 0.2, .block = 0.1, .shift_m = 5.0, .scale = 0.02, .tilt_deg = 2.0};
  EXPECT_EQ(simulated(100, quality, 7).cells, simulated(100, quality, 7).cells);
  EXPECT_NE(simulated(100, quality, 7).cells, simulated(100, quality, 8).cells);
}

}  // namespace
}  // namespace roadfix
