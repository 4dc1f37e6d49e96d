#include "core/grid/halving_kernel.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <random>
#include <string>

#include "core/grid/resample.hpp"
#include "tests/support/random_cells.hpp"

namespace roadfix {
namespace {

CellArray one_by_one(const CellArray& cells) {
  CellArray result((cells.cols() + 1) / 2, (cells.rows() + 1) / 2);
  for (int row = 0; row < result.rows(); ++row) {
    for (int col = 0; col < result.cols(); ++col) {
      int sum = 0;
      int count = 0;
      for (const Cell cell : {cells.get(2 * col, 2 * row), cells.get(2 * col + 1, 2 * row),
                              cells.get(2 * col, 2 * row + 1), cells.get(2 * col + 1, 2 * row + 1)}) {
        if (!is_observed(cell)) continue;
        sum += cell;
        ++count;
      }
      if (count > 0) result.at(col, row) = static_cast<Cell>((sum + count / 2) / count);
    }
  }
  return result;
}

/// Each instruction set that this processor has, in turn.
class HalvedOnEachTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_P(HalvedOnEachTarget, HasTheRoundedMeansOfTheObservedCellsForEverySize) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 400; ++round) {
    const int cols = static_cast<int>(random() % 150);
    const int rows = static_cast<int>(random() % 8);
    const CellArray cells = testing::random_cells(random, cols, rows, 0.25 * (round % 5));
    ASSERT_EQ(halved(cells), one_by_one(cells)) << cols << " x " << rows << ", round " << round;
  }
}

TEST_P(HalvedOnEachTarget, RoundsEverySumOfOneToFourCellsAsDivisionDoes) {
  constexpr int kMax = kRoad;
  CellArray cells(8 * (4 * kMax + 1), 2);
  int col = 0;
  for (int observed = 1; observed <= 4; ++observed) {
    for (int sum = 0; sum <= observed * kMax; ++sum, col += 2) {
      int rest = sum;
      for (int k = 0; k < observed; ++k) {
        const int cell = std::min(rest, kMax);
        cells.at(col + k % 2, k / 2) = static_cast<Cell>(cell);
        rest -= cell;
      }
    }
  }
  EXPECT_EQ(halved(cells), one_by_one(cells));
}

INSTANTIATE_TEST_SUITE_P(Targets, HalvedOnEachTarget, ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace roadfix
