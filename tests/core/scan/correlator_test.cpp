#include "core/scan/correlator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace roadfix {
namespace {

FloatPlane noise(int cols, int rows, std::mt19937_64& random) {
  std::uniform_real_distribution<float> values(-1.0F, 1.0F);
  FloatPlane plane(cols, rows);
  for (float& value : plane.values) value = values(random);
  return plane;
}

double at(const FloatPlane& plane, int col, int row) {
  const bool within = col >= 0 && row >= 0 && col < plane.cols && row < plane.rows;
  return within ? static_cast<double>(plane.at(col, row)) : 0.0;
}

/// With the patch's first cell at (col, row), or turned by half a turn its last one.
double sum_at(const FloatPlane& plane, const FloatPlane& patch, int col, int row, bool half_turn) {
  const int sign = half_turn ? -1 : 1;
  double sum = 0.0;
  for (int r = 0; r < patch.rows; ++r) {
    for (int c = 0; c < patch.cols; ++c) sum += at(plane, col + sign * c, row + sign * r) * at(patch, c, r);
  }
  return sum;
}

FloatPlanes correlated(const Correlator& correlator, const FloatPlane& patch, const FloatPlane& second,
                       bool half_turn) {
  Correlator::Workspace workspace(correlator.side());
  Spectrum spectrum(correlator.side());
  correlator.spectrum_of(patch, second, workspace, spectrum);
  FloatPlanes sums;
  correlator.correlate(spectrum, half_turn, workspace, sums);
  return sums;
}

void expect_sums(const FloatPlane& plane, const FloatPlane& patch, int side, bool half_turn, const FloatPlane& sums) {
  constexpr int kLead = Correlator::kLead;
  const int before = half_turn ? side - 1 : 0;
  const int after = half_turn ? 0 : side - 1;
  for (int row = before - kLead; row < plane.rows + kLead - after; ++row) {
    for (int col = before - kLead; col < plane.cols + kLead - after; ++col) {
      ASSERT_NEAR(at(sums, col + kLead, row + kLead), sum_at(plane, patch, col, row, half_turn), 2e-4)
          << plane.cols << " x " << plane.rows << ", " << side << " at " << col << ", " << row;
    }
  }
}

TEST(Correlator, SumsPairsOfPatchesAndPairsOfPlanesAsPlainLoopsDo) {
  std::mt19937_64 random(1);
  // One tile, many tiles, a patch as large as the plane, and larger.
  const std::vector<std::array<int, 3>> sizes{{20, 30, 5},  {70, 41, 9}, {90, 100, 31},
                                              {13, 12, 12}, {7, 9, 12},  {300, 11, 11}};
  for (const auto& [cols, rows, side] : sizes) {
    const FloatPlane plane = noise(cols, rows, random);
    const FloatPlane other = noise(cols, rows, random);
    const FloatPlane patch = noise(side, side, random);
    const FloatPlane second = noise(side, side - 1, random);
    for (const int overlap : {0, 2}) {
      const Correlator one(plane, {}, side, overlap);
      const Correlator two(plane, other, side, overlap);
      for (const bool half_turn : {false, true}) {
        const FloatPlanes patches = correlated(one, patch, second, half_turn);
        expect_sums(plane, patch, side, half_turn, patches.first);
        expect_sums(plane, second, side, half_turn, patches.second);
        const FloatPlanes planes = correlated(two, patch, {}, half_turn);
        expect_sums(plane, patch, side, half_turn, planes.first);
        expect_sums(other, patch, side, half_turn, planes.second);
      }
    }
  }
}

TEST(Correlator, TakesFewTilesAlsoForAPatchThatAllButFillsASide) {
  for (const int patch : {250, 381, 509, 765, 1021}) {
    const FloatPlane plane(patch + 200, patch + 200);
    EXPECT_LE(Correlator(plane, {}, patch, 2).tiles(), 4U) << patch;
  }
}

TEST(Correlator, KnowsTheSumsWhereAllCellsAreAlike) {
  std::mt19937_64 random(2);
  for (const bool pair : {false, true}) {
    FloatPlane plane(290, 280);
    std::ranges::fill(plane.values, 0.7F);
    plane.at(3, 2) = -1.0F;  // beside it, and at the plane's edges, transforms are needed
    FloatPlane other = plane;
    std::ranges::fill(other.values, -0.2F);
    const int side = 5;
    const FloatPlane patch = noise(side, side, random);
    const FloatPlane second = noise(side, side, random);
    const Correlator correlator(plane, pair ? other : FloatPlane(), side, 2);
    EXPECT_LT(correlator.bytes(), correlator.tiles() * Spectrum(correlator.side()).bytes());
    for (const bool half_turn : {false, true}) {
      const FloatPlanes sums = correlated(correlator, patch, pair ? FloatPlane() : second, half_turn);
      expect_sums(plane, patch, side, half_turn, sums.first);
      expect_sums(pair ? other : plane, pair ? patch : second, side, half_turn, sums.second);
    }
  }
}

}  // namespace
}  // namespace roadfix
