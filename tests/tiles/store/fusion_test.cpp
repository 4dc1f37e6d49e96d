#include "tiles/store/fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/ascii_map.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;
using testing::to_ascii;

/// The definition, cell by cell in floating point: mean of log-odds of those who saw the cell.
Cell pooled(const std::vector<Cell>& cells) {
  std::vector<Cell> observed;
  std::ranges::copy_if(cells, std::back_inserter(observed), is_observed);
  if (observed.empty()) return kUnobserved;
  if (observed.size() == 1) return observed.front();
  double sum = 0.0;
  for (const Cell cell : observed) {
    const double p = std::clamp(probability(cell), 1.0 / 1016.0, 1015.0 / 1016.0);
    sum += std::log(p / (1.0 - p));
  }
  return cell_from_probability(1.0 / (1.0 + std::exp(-sum / static_cast<double>(observed.size()))));
}

TEST(Fusion, OneSourceIsCopied) {
  const CellArray source = from_ascii("#.?5");
  EXPECT_EQ(fused(std::vector{source}), source);
}

TEST(Fusion, EachSourceFillsWhatTheOthersDidNotSee) {
  EXPECT_EQ(to_ascii(fused(std::vector{from_ascii("#??."), from_ascii("?.?.")})), "#.?.\n");
}

TEST(Fusion, EqualCertaintyAgainstEachOtherGivesOneHalf) {
  EXPECT_EQ(fused(std::vector{from_ascii("#"), from_ascii(".")}).at(0, 0), 127);
}

TEST(Fusion, RepeatingASourceChangesNothing) {
  CellArray all(256, 1);
  for (int k = 0; k < 256; ++k) all.at(k, 0) = static_cast<Cell>(k);
  for (int n = 1; n <= 5; ++n) EXPECT_EQ(fused(std::vector<CellArray>(static_cast<std::size_t>(n), all)), all);
}

TEST(Fusion, IsTheMeanOfTheLogOddsForEveryPairOfCells) {
  CellArray a(256, 256);
  CellArray b(256, 256);
  for (int row = 0; row < 256; ++row) {
    for (int col = 0; col < 256; ++col) {
      a.at(col, row) = static_cast<Cell>(col);
      b.at(col, row) = static_cast<Cell>(row);
    }
  }
  const CellArray result = fused(std::vector{a, b});
  for (int row = 0; row < 256; ++row) {
    for (int col = 0; col < 256; ++col) {
      // The halves of exact ties may fall to either side.
      EXPECT_NEAR(result.at(col, row), pooled({a.at(col, row), b.at(col, row)}), 1) << col << " " << row;
    }
  }
}

TEST(Fusion, DependsOnNoOrder) {
  std::mt19937_64 random(5);
  std::vector<CellArray> sources(4, CellArray(64, 64));
  for (CellArray& source : sources) {
    for (Cell& cell : source.cells()) cell = static_cast<Cell>(random() % 256);
  }
  std::vector<int> order{0, 1, 2, 3};
  const CellArray expected = fused(sources);
  while (std::ranges::next_permutation(order).found) {
    std::vector<CellArray> shuffled;
    for (const int i : order) shuffled.push_back(sources[static_cast<std::size_t>(i)]);
    EXPECT_EQ(fused(shuffled), expected);
  }
}

}  // namespace
}  // namespace roadfix
