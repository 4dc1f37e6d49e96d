#include "core/scan/scan_kernel.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace roadfix {
namespace {

std::vector<float> noise(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<float> values(-1.0F, 1.0F);
  std::vector<float> result(count + kRowOverrun);
  for (float& value : result) value = values(random);
  return result;
}

/// Each instruction set that this processor has, in turn.
class ScanRowsOnEachTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_P(ScanRowsOnEachTarget, AreScoredByTheirDefinition) {
  std::mt19937_64 random(1);
  for (std::size_t cols = 1; cols < 70; ++cols) {
    const auto sums = noise(cols, random);
    const auto above = noise(cols, random);
    const auto below = noise(cols, random);
    const auto gain0 = noise(cols, random);
    const auto gain1 = noise(cols, random);
    auto eligible = noise(cols, random);
    for (float& value : eligible) value = value > 0.0F ? 1.0F : 0.0F;
    std::vector<float> out(cols + kRowOverrun);
    const ScoreRow row{sums.data(), 0.5F,           {above.data(), below.data()}, {gain0.data(), gain1.data()},
                       0.25F,       eligible.data()};
    score_row(row, static_cast<int>(cols), out.data());
    for (std::size_t i = 0; i < cols; ++i) {
      const float correction = 0.75F * above[i] + 0.25F * below[i];
      const float gain = 0.75F * gain0[i] + 0.25F * gain1[i];
      EXPECT_NEAR(out[i], eligible[i] * (0.5F * sums[i] - correction) * gain, 1e-5F) << i << " of " << cols;
    }
  }
}

TEST_P(ScanRowsOnEachTarget, HavePeaksWhereNoNeighbourIsHigher) {
  std::mt19937_64 random(2);
  for (int cols = 3; cols < 70; ++cols) {
    auto above = noise(static_cast<std::size_t>(cols), random);
    auto row = noise(static_cast<std::size_t>(cols), random);
    auto below = noise(static_cast<std::size_t>(cols), random);
    // Equal neighbours, and places that do not count.
    row[1] = row[2] = 0.9F;
    for (std::size_t i = 0; i < row.size(); i += 5) row[i] = 0.0F;
    std::vector<int> peaks;
    const RowTotals totals = summarize_row(above.data(), row.data(), below.data(), 1, cols - 1, 0.3F, peaks);
    std::vector<int> expected;
    double squares = 0.0;
    int poses = 0;
    for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(cols); ++i) {
      squares += static_cast<double>(row[i] * row[i]);
      poses += row[i] != 0.0F ? 1 : 0;
      float around = std::max(row[i - 1], row[i + 1]);
      for (const auto* other : {&above, &below}) {
        around = std::max({around, (*other)[i - 1], (*other)[i], (*other)[i + 1]});
      }
      if (row[i] > 0.3F && row[i] >= around) expected.push_back(static_cast<int>(i));
    }
    EXPECT_EQ(peaks, expected);
    EXPECT_EQ(totals.poses, poses);
    EXPECT_NEAR(totals.squares, squares, 1e-5 * cols);
  }
}

TEST_P(ScanRowsOnEachTarget, HaveMeansOnlyWhereEnoughIsObservedAndVaries) {
  std::mt19937_64 random(3);
  for (std::size_t count = 1; count < 70; ++count) {
    auto n = noise(count, random);
    for (float& value : n) value = 100.0F * value + 60.0F;
    const auto l = noise(count, random);
    const auto m = noise(count, random);
    const auto ll = noise(count, random);  // squares below 0 stand for a spread that is too small
    const auto mm = noise(count, random);
    std::vector<float> correction(count, -1.0F);
    std::vector<float> gain(count, -1.0F);
    means_of_blocks({n.data(), l.data(), ll.data(), m.data(), mm.data()}, {150.0F, 30.0F, 1e-3F},
                    static_cast<int>(count), correction.data(), gain.data());
    for (std::size_t i = 0; i < count; ++i) {
      const double cells = static_cast<double>(n[i]);
      const double map_spread =
          static_cast<double>(mm[i]) - static_cast<double>(m[i]) * static_cast<double>(m[i]) / cells;
      const double feature_spread =
          static_cast<double>(ll[i]) - static_cast<double>(l[i]) * static_cast<double>(l[i]) / cells;
      const double min = std::min(map_spread, feature_spread) - 1e-3 * cells;
      if (cells >= 30.0 && std::abs(min) < 1e-4) continue;  // may fall either way
      const bool scored = cells >= 30.0 && min > 0.0;
      const double product = static_cast<double>(m[i]) * static_cast<double>(l[i]) / cells;
      EXPECT_NEAR(correction[i], scored ? product : 0.0, 1e-5) << i << " of " << count;
      const double expected = scored ? std::sqrt(cells / 150.0 / (map_spread * feature_spread)) : 0.0;
      EXPECT_NEAR(gain[i], expected, 1e-3 * (1.0 + expected)) << i << " of " << count;
    }
  }
}

TEST_P(ScanRowsOnEachTarget, LieBetweenTheirBlocks) {
  std::mt19937_64 random(4);
  const auto blocks = noise(9, random);
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<std::int32_t> first(count + kRowOverrun);
    std::vector<std::int32_t> second(count + kRowOverrun);
    for (std::size_t i = 0; i < count; ++i) {
      first[i] = static_cast<std::int32_t>(random() % 9);
      second[i] = static_cast<std::int32_t>(random() % 9);
    }
    const auto share = noise(count, random);
    std::vector<float> out(count + kRowOverrun);
    interpolate_blocks(blocks.data(), first.data(), second.data(), share.data(), static_cast<int>(count), out.data());
    for (std::size_t i = 0; i < count; ++i) {
      const float a = blocks[static_cast<std::size_t>(first[i])];
      const float b = blocks[static_cast<std::size_t>(second[i])];
      EXPECT_NEAR(out[i], a + share[i] * (b - a), 1e-5F) << i << " of " << count;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, ScanRowsOnEachTarget, ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace roadfix
