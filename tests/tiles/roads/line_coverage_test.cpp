#include "tiles/roads/line_coverage.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/repeats.hpp"

namespace roadfix {
namespace {

constexpr GridGeometry kBlock{2.0, {100, -200}, 24, 20};

double share_of(const LineCoverage& coverage, int col, int row) {
  return coverage.covered(col, row) / static_cast<double>(LineCoverage::kSamples);
}

double distance_to_segment(GridPoint p, GridPoint a, GridPoint b) {
  const double dx = b.east_m - a.east_m;
  const double dy = b.north_m - a.north_m;
  const double length2 = dx * dx + dy * dy;
  const double t =
      length2 > 0.0 ? std::clamp(((p.east_m - a.east_m) * dx + (p.north_m - a.north_m) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.east_m - a.east_m - t * dx, p.north_m - a.north_m - t * dy);
}

/// Share of 32 x 32 points of the cell that lie on a road.
double share_by_counting(int col, int row, const std::vector<std::array<GridPoint, 2>>& roads, double half_width) {
  constexpr int kSide = 32;
  int covered = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int across = i % kSide;
    const int down = i / kSide;
    const GridPoint p = kBlock.point_at({col + (across + 0.5) / kSide, row + (down + 0.5) / kSide});
    covered +=
        std::ranges::any_of(roads, [&](const auto& r) { return distance_to_segment(p, r[0], r[1]) <= half_width; });
  }
  return covered / static_cast<double>(kSide * kSide);
}

TEST(LineCoverage, EqualsCountingOfPointsForManyRandomRoads) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> around(-0.3, 1.3);
  const GridBox box = kBlock.box();
  const auto point = [&] {
    return GridPoint{box.min.east_m + around(random) * box.width_m(),
                     box.min.north_m + around(random) * box.height_m()};
  };
  constexpr int kTrials = 5 * testing::repeats(8);
  for (int trial = 0; trial < kTrials; ++trial) {
    const double half_width = 0.4 + 10.0 * trial / kTrials;
    std::vector<std::array<GridPoint, 2>> roads{{point(), point()}, {point(), point()}};
    if (trial % 5 == 0) roads[1][1] = roads[1][0];                  // a point
    if (trial % 5 == 1) roads[1][1].north_m = roads[1][0].north_m;  // due east
    if (trial % 5 == 2) roads[1][1].east_m = roads[1][0].east_m;    // due north
    LineCoverage coverage(kBlock);
    for (const auto& road : roads) coverage.add(road[0], road[1], half_width);
    double error = 0.0;
    for (int row = 0; row < kBlock.rows; ++row) {
      for (int col = 0; col < kBlock.cols; ++col) {
        const double expected = share_by_counting(col, row, roads, half_width);
        ASSERT_NEAR(share_of(coverage, col, row), expected, 0.15) << "trial " << trial << " cell " << col << ' ' << row;
        error += share_of(coverage, col, row) - expected;
      }
    }
    EXPECT_NEAR(error / (kBlock.cols * kBlock.rows), 0.0, 0.006) << "trial " << trial;
  }
}

TEST(LineCoverage, CountsGroundUnderTwoRoadsOnce) {
  LineCoverage coverage(kBlock);
  const GridBox box = kBlock.box();
  for (int i = 0; i < 2; ++i) coverage.add(box.min, box.max, 1.0);
  LineCoverage once(kBlock);
  once.add(box.min, box.max, 1.0);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(share_of(coverage, i, 19 - i), share_of(once, i, 19 - i));
}

TEST(LineCoverage, AStraightRoadHasItsWidthAndPlace) {
  LineCoverage coverage(kBlock);
  const GridBox box = kBlock.box();
  const double east = box.min.east_m + 11.0;  // 7 m wide: 7.5 to 14.5 m, cells 3.75 to 7.25
  coverage.add({east, box.min.north_m - 50.0}, {east, box.max.north_m + 50.0}, 3.5);
  const std::array<double, 9> expected{0, 0, 0, 0.25, 1, 1, 1, 0.25, 0};
  for (int col = 0; col < 9; ++col) {
    EXPECT_EQ(share_of(coverage, col, 10), expected[static_cast<std::size_t>(col)]) << col;
  }
}

TEST(LineCoverage, FarAwayAndHugeRoadsAreHarmless) {
  LineCoverage coverage(kBlock);
  coverage.add({-1e9, -1e9}, {1e9, -1e9}, 5.0);
  EXPECT_EQ(share_of(coverage, 5, 5), 0.0);
  coverage.add({-1e7, kBlock.cell_center(0, 10).north_m}, {1e7, kBlock.cell_center(0, 10).north_m}, 3.0);
  EXPECT_EQ(share_of(coverage, 5, 10), 1.0);
  EXPECT_EQ(share_of(coverage, 5, 15), 0.0);
}

}  // namespace
}  // namespace roadfix
