#include "core/proof/score_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace roadfix {
namespace {

constexpr double kSpan = 200.0;

/// The cells observed in both at one pose.
struct Pose {
  std::vector<double> feature, map;
};

MatchSums sums_at(const Pose& pose) {
  MatchSums sums;
  for (std::size_t i = 0; i < pose.map.size(); ++i) sums.add(pose.map[i], pose.feature[i]);
  return sums;
}

double score(const Pose& pose, const FootprintCells& footprint) { return score_of(sums_at(pose), footprint); }

void include(Interval& interval, double value) {
  interval = {std::min(interval.min, value), std::max(interval.max, value)};
}

/// What holds for each of the poses, and no more.
BlockSums sums_of(const std::vector<Pose>& poses, double base) {
  BlockSums s{-1.0, {1e18, -1.0}, 1e18, -1.0, {1e18, -1.0}, 1e18, {1e18, -1.0}, base, kSpan};
  for (const Pose& pose : poses) {
    double cross = 0.0;
    for (std::size_t i = 0; i < pose.map.size(); ++i) cross += std::max(0.0, pose.feature[i] - base) * pose.map[i];
    const MatchSums sums = sums_at(pose);
    s.cross_max = std::max(s.cross_max, cross);
    include(s.map, sums.m);
    s.map_square_min = std::min(s.map_square_min, sums.mm);
    s.map_mixed_max = std::max(s.map_mixed_max, kSpan * sums.m - sums.mm);
    include(s.feature, sums.l);
    s.feature_square_min = std::min(s.feature_square_min, sums.ll);
    include(s.cells, static_cast<double>(sums.n));
  }
  return s;
}

class ScoreBound : public ::testing::Test {
 protected:
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  /// Roads are certain, or as sure as noise; the map agrees with the feature map in most cells.
  Pose pose(int cells) {
    const bool binary = integer(0, 1) == 1;
    const auto value = [&](bool road) {
      const int noise = integer(0, binary ? 0 : 80);
      return static_cast<double>(road ? 200 - noise : noise);
    };
    Pose result;
    for (int i = 0; i < cells; ++i) {
      const bool road = integer(0, 4) == 0;
      result.feature.push_back(value(road));
      result.map.push_back(value(integer(0, 9) == 0 ? !road : road));
    }
    return result;
  }
  std::vector<Pose> poses(int count, int fewest_cells) {
    std::vector<Pose> all;
    for (int i = 0; i < count; ++i) all.push_back(pose(integer(fewest_cells, kCells)));
    return all;
  }

  static constexpr int kCells = 60;
  static constexpr FootprintCells kFootprint{kCells, 0.5 * kCells};
  std::mt19937_64 random_{11};
};

TEST_F(ScoreBound, IsExceededByNoPoseOfABlock) {
  double slack = 0.0;
  int exceeded = 0;
  constexpr int kBlocks = 3000;
  for (int i = 0; i < kBlocks; ++i) {
    const std::vector<Pose> block = poses(integer(1, 6), kCells / 3);
    const double bound = score_bound(sums_of(block, integer(0, 60)), kFootprint);
    double best = 0.0;
    for (const Pose& at : block) best = std::max(best, score(at, kFootprint));
    exceeded += best > bound ? 1 : 0;
    slack += bound - best;
  }
  EXPECT_EQ(exceeded, 0);
  EXPECT_LT(slack / kBlocks, 0.5) << "it excludes something";
}

TEST_F(ScoreBound, IsTheScoreOfASinglePoseOfWhichAllIsKnown) {
  for (int i = 0; i < 500; ++i) {
    const std::vector<Pose> alone = poses(1, kCells / 2);
    EXPECT_NEAR(score_bound(sums_of(alone, 0.0), kFootprint), std::max(0.0, score(alone[0], kFootprint)), 1e-5);
  }
}

TEST_F(ScoreBound, IsZeroWhereTooLittleIsObservedOrTheMapHoldsNoRoad) {
  EXPECT_EQ(score_bound(sums_of(poses(3, kCells), 20.0), {std::int64_t{3} * kCells, 1.5 * kCells}), 0.0);
  Pose empty = pose(kCells);
  std::ranges::fill(empty.map, 0.0);
  EXPECT_EQ(score_bound(sums_of({empty}, 20.0), kFootprint), 0.0);
}

TEST_F(ScoreBound, ReachesAScoreJustWhereAsMuchIsFoundAsThatNeeds) {
  int possible = 0;
  for (int i = 0; i < 1000; ++i) {
    BlockSums sums = sums_of(poses(integer(1, 4), kCells / 2), integer(0, 40));
    const double wanted = 0.05 * integer(2, 18);
    const double needed = cross_needed(sums, kFootprint, wanted);
    if (!std::isfinite(needed)) {
      EXPECT_LT(score_bound(sums, kFootprint), wanted);
      continue;
    }
    ++possible;
    sums.cross_max = needed + 1e-3;
    EXPECT_GE(score_bound(sums, kFootprint), wanted);
    if (needed == 0.0) continue;  // any pose may have it
    sums.cross_max = needed - 1e-3;
    EXPECT_LT(score_bound(sums, kFootprint), wanted);
  }
  EXPECT_GT(possible, 500);
}

}  // namespace
}  // namespace roadfix
