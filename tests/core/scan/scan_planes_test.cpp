#include "core/scan/scan_planes.hpp"

#include <gtest/gtest.h>

#include "core/scan/scan_kernel.hpp"

namespace roadfix {
namespace {

TEST(BlockSums, BeginBeforeTheFirstCell) {
  CellArray cells(4, 1, kRoad);
  cells.at(3, 0) = kUnobserved;
  const BlockSumPlanes sums = block_sums(cells, 0.5, {3, 2});
  ASSERT_EQ(sums.observed.cols, 2);
  ASSERT_EQ(sums.observed.rows, 1);
  EXPECT_EQ(sums.observed.at(0, 0), 1.0F);
  EXPECT_EQ(sums.observed.at(1, 0), 2.0F);
  EXPECT_EQ(sums.value.at(1, 0), 1.0F);
  EXPECT_EQ(sums.square.at(1, 0), 0.5F);
}

TEST(InterpolationTaps, LieBetweenTheBlocksAroundACellAndAtTheRimWithinThePlane) {
  // Blocks of 4 cells; the one with cell 0 is the second of three: they begin at cells -4, 0 and 4.
  const InterpolationTaps taps = interpolation_taps({4, 1, 3}, -6, 16);
  EXPECT_GE(taps.share.size(), 16U + kRowOverrun);
  const auto expect_at = [&](int cell, int first, int second, float share) {
    const auto i = static_cast<std::size_t>(cell + 6);
    EXPECT_EQ(taps.first[i], first) << "cell " << cell;
    EXPECT_EQ(taps.second[i], second) << "cell " << cell;
    EXPECT_EQ(taps.share[i], share) << "cell " << cell;
  };
  expect_at(-6, 0, 0, 0.5F);
  expect_at(-4, 0, 1, 0.0F);
  expect_at(-1, 0, 1, 0.75F);
  expect_at(0, 1, 2, 0.0F);
  expect_at(3, 1, 2, 0.75F);
  expect_at(5, 2, 2, 0.25F);
  expect_at(9, 2, 2, 0.25F);
}

}  // namespace
}  // namespace roadfix
