#include "core/grid/bilinear_kernel.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "core/units/draws.hpp"
#include "tests/support/random_cells.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::random_cells;

/// Of the middle of the cell (col, row) of the result, as a run tells it.
GridGeometry::CellPosition position_of(const SnappedPlacement& placement, int col, int row) {
  const SnappedPlacement::Run run = placement.run_at(col, row);
  const auto snapped = [](std::int32_t at) {
    constexpr int kDropped = SnappedPlacement::kCellBits - SnappedPlacement::kShareBits;
    return (at >> kDropped) / static_cast<double>(1 << SnappedPlacement::kShareBits) - 0.5;
  };
  return {snapped(run.col), snapped(run.row)};
}

CellArray one_by_one(const CellArray& source, const Placement& placement, int cols, int rows) {
  const SnappedPlacement snapped(placement);
  CellArray result(cols, rows);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      result.at(col, row) = bilinear(source, position_of(snapped, col, row));
    }
  }
  return result;
}

/// Each instruction set that this processor has, in turn.
class BilinearOnEachTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_P(BilinearOnEachTarget, ReadsEveryCellAsBilinearDoesAtTheSnappedPositionToTheLastBit) {
  std::mt19937_64 random(5);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  for (int round = 0; round < 300; ++round) {
    const double holes = round % 3 == 0 ? 0.0 : 0.15 * (round % 6);
    const CellArray source = random_cells(random, 1 + below(70), 1 + below(50), holes);
    // Quarter turns put positions exactly on cells and between them, where rounding shows.
    const double turn = round % 4 == 0 ? std::numbers::pi / 2 * below(4) : uniform(random, -4.0, 4.0);
    const double stretch = round % 5 == 0 ? uniform(random, 0.4, 1.6) : 1.0;
    const Placement placement{{uniform(random, -20, 60), uniform(random, -20, 60)},
                              {stretch * std::cos(turn), stretch * std::sin(turn)},
                              {-stretch * std::sin(turn), stretch * std::cos(turn)}};
    const int cols = 1 + below(round % 10 == 0 ? 600 : 90);
    const int rows = 1 + below(60);
    ASSERT_EQ(BilinearSource(source).sampled(placement, cols, rows), one_by_one(source, placement, cols, rows))
        << "round " << round;
  }
}

TEST(SnappedPlacement, LiesWithinATwoHundredthOfACellOfThePlacement) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 200; ++round) {
    const double turn = uniform(random, -4.0, 4.0);
    const Placement placement{{uniform(random, -2000, 4000), uniform(random, -2000, 4000)},
                              {std::cos(turn), -std::sin(turn)},
                              {std::sin(turn), std::cos(turn)}};
    const SnappedPlacement snapped(placement);
    const int col = static_cast<int>(random() % 5000);
    const int row = static_cast<int>(random() % 5000);
    const auto exact = placement.source_of(col + 0.5, row + 0.5);
    const auto found = position_of(snapped, col, row);
    EXPECT_NEAR(found.col, exact.col, 0.005);
    EXPECT_NEAR(found.row, exact.row, 0.005);
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, BilinearOnEachTarget, ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace roadfix
