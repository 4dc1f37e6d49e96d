#include "cli/bench/query_poses.hpp"

#include <gtest/gtest.h>

namespace roadfix::bench {
namespace {

TEST(DrawPose, KeepsTheWholeFootprintInTheRegionAndOffTheUnobserved) {
  const PoseSampling sampling{{{0, 0}, {100, 100}}, {30, 20}, [](GridPoint p) { return p.east_m > 50.0; }};
  evaluation::Random random = evaluation::stream(1, 0, 0);
  for (int i = 0; i < 50; ++i) {
    const auto pose = draw_pose(sampling, random);
    ASSERT_TRUE(pose);
    for (const GridPoint corner : corners(sampling.footprint, *pose)) {
      EXPECT_TRUE(sampling.region.contains(corner));
      EXPECT_GT(corner.east_m, 48.0);  // observed points start half a lattice step inside the footprint
    }
  }
}

TEST(DrawPose, GivesUpWhereNothingFits) {
  evaluation::Random random = evaluation::stream(1, 0, 0);
  EXPECT_FALSE(draw_pose({{{0, 0}, {10, 10}}, {30, 30}, [](GridPoint) { return true; }}, random));
}

TEST(DrawPose, IsUniformOverTheHeadings) {
  const PoseSampling sampling{{{0, 0}, {1000, 1000}}, {1, 1}, [](GridPoint) { return true; }};
  evaluation::Random random = evaluation::stream(7, 0, 0);
  int east = 0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) east += draw_pose(sampling, random)->heading.degrees() < 180.0;
  EXPECT_NEAR(east, kDraws * 0.5, 5 * 22);  // 5 sigma of a fair coin
}

TEST(Without, TakesTheSharesOffTheNamedSides) {
  const GridBox box = without({{0, 0}, {100, 200}}, {.top = 0.1, .bottom = 0.2, .left = 0.3, .right = 0.0});
  EXPECT_EQ(box.min, (GridPoint{30, 40}));
  EXPECT_EQ(box.max, (GridPoint{100, 180}));
}

}  // namespace
}  // namespace roadfix::bench
