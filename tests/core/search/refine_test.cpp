#include "core/search/refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/match/footprint.hpp"
#include "core/search/ground_around.hpp"
#include "tests/core/search/seen_town.hpp"

namespace roadfix {
namespace {

const Deadline kUnlimited;
constexpr RefineReach kReach{.cells = 2, .bins = 2};

struct RefinedTown : testing::SeenTown {
  explicit RefinedTown(std::uint64_t seed) : SeenTown(seed, 600, 500, 200.0, 90, 80) {}

  /// Anywhere in it.
  std::vector<LatticePose> poses(const Level& level, int count) {
    std::vector<LatticePose> result;
    for (int i = 0; i < count; ++i) {
      const GridPose pose = testing::pose_within(region.box, 10.0, random);
      result.push_back({lattice_index(pose.position, level.cell_m()), level.bins.nearest(pose.heading)});
    }
    return result;
  }
};

/// The best of all poses within +- 2 cells and bins.
double best_within_reach(const Level& level, const LatticePose& pose) {
  const MapPlane plane(level.read(window_around(level, pose, 2)).cells);
  const std::vector<PlaneCell> places = places_around({plane.cols() / 2, plane.rows() / 2}, 2);
  std::vector<MatchSums> sums(places.size());
  double best = 0.0;
  for (int bin = pose.bin - 2; bin <= pose.bin + 2; ++bin) {
    match_sums(plane, footprint_at(level.features.rotator, level.bins.heading(bin)), places, sums);
    for (const MatchSums& each : sums) best = std::max(best, score_of(each, level.features.cells));
  }
  return best;
}

/// Footprints that share a turned feature map are rounded differently.
constexpr double kRounding = 1e-3;

TEST(Refine, FindsTheBestOfAllPosesWithinReachOfOneNextToAPeak) {
  int poses = 0;
  int missed = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    RefinedTown town(seed);
    const SearchLevels levels = town.levels();
    const Level& level = levels.finest();
    std::vector<LatticePose> begin = town.poses(level, 60);
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(refine(level, kReach, kUnlimited, begin));
    const auto shift = [&] { return static_cast<int>(town.random() % 3) - 1; };
    for (LatticePose& pose : begin) {
      pose = {{pose.cell.col + shift(), pose.cell.row + shift()}, level.bins.wrapped(pose.bin + shift())};
    }
    std::vector<LatticePose> found = begin;
    ASSERT_TRUE(refine(level, kReach, kUnlimited, found));
    for (std::size_t i = 0; i < begin.size(); ++i) {
      const double best = best_within_reach(level, begin[i]);
      EXPECT_LE(found[i].score, best + kRounding);
      EXPECT_LE(std::abs(found[i].cell.col - begin[i].cell.col), 2);
      EXPECT_LE(std::abs(found[i].cell.row - begin[i].cell.row), 2);
      EXPECT_LE(level.bins.distance(found[i].bin, begin[i].bin), 2);
      ++poses;
      missed += found[i].score < best - kRounding ? 1 : 0;
    }
  }
  EXPECT_LE(missed, poses / 10);
}

TEST(Refine, ReachesAPeakTwoCellsAndBinsAway) {
  RefinedTown town(4);
  const SearchLevels levels = town.levels();
  const Level& level = levels.finest();
  std::vector<LatticePose> peak = town.poses(level, 40);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(refine(level, kReach, kUnlimited, peak));
  const auto top = std::ranges::max_element(peak, {}, &LatticePose::score);
  std::vector<LatticePose> beside{{{top->cell.col + 2, top->cell.row - 2}, level.bins.wrapped(top->bin + 2)}};
  ASSERT_TRUE(refine(level, kReach, kUnlimited, beside));
  EXPECT_EQ(beside.front().cell, top->cell);
  EXPECT_EQ(beside.front().bin, top->bin);
  EXPECT_EQ(beside.front().score, top->score);
}

TEST(GroundAround, GivesTheSameSumsForAFootprintThatHeadingsAQuarterTurnApartShare) {
  RefinedTown town(5);
  const SearchLevels levels = town.levels();
  const Level& level = levels.finest();
  ASSERT_EQ(level.bins.count() % 4, 0);
  const std::vector<LatticePose> poses = town.poses(level, 50);
  const GroundAround as_it_is(level, {}, kUnlimited, poses);
  const GroundAround rotated(level, {.headings = level.bins.count()}, kUnlimited, poses);
  ASSERT_FALSE(as_it_is.rotated());
  ASSERT_TRUE(rotated.rotated());
  std::vector<std::size_t> each(poses.size());
  std::iota(each.begin(), each.end(), 0);
  std::vector<LatticeIndex> cells;
  for (const LatticePose& pose : poses) cells.push_back(pose.cell);
  const int quarter = level.bins.count() / 4;
  const auto footprint_of = [&](int bin) { return footprint_at(level.features.rotator, level.bins.heading(bin)); };
  for (int quarters = 0; quarters < 4; ++quarters) {
    std::vector<MatchSums> shared(cells.size());
    std::vector<MatchSums> own(cells.size());
    rotated.match(footprint_of(3), quarters, each, cells, shared);
    as_it_is.match(footprint_of(3 + quarters * quarter), 0, each, cells, own);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      EXPECT_EQ(shared[i].n, own[i].n);
      EXPECT_NEAR(shared[i].ml, own[i].ml, 0.01 * own[i].ml) << quarters;
      EXPECT_NEAR(shared[i].mm, own[i].mm, 1e-9);
    }
  }
}

}  // namespace
}  // namespace roadfix
