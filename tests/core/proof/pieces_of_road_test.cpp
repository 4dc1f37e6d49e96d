// Roads as straight pieces: the lines that both sides of a bound consist of, and which of them a feature map holds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/proof/line_stencil.hpp"
#include "core/proof/road_lines.hpp"

namespace roadfix {
namespace {

constexpr int kSeenSide = 64;
constexpr int kRoadValue = 200;
constexpr int kBase = 20;

/// Of certain width, through the middle; `angle` from columns towards rows.
FeatureMap road_at(double angle, double half_width = 1.0) {
  CellArray cells(kSeenSide, kSeenSide, kNoRoad);
  for (int row = 0; row < kSeenSide; ++row) {
    for (int col = 0; col < kSeenSide; ++col) {
      const double across =
          (row + 0.5 - kSeenSide / 2.0) * std::cos(angle) - (col + 0.5 - kSeenSide / 2.0) * std::sin(angle);
      if (std::abs(across) <= half_width) cells.at(col, row) = kRoadValue;
    }
  }
  return FeatureMap::centred(std::move(cells), 4.0);
}

TEST(LineStencil, IsAConnectedLineOfSixteenCellsInItsDirection) {
  for (int i = 0; i < kLineDirections; ++i) {
    const double angle = std::numbers::pi * i / kLineDirections;
    const auto& line = line_stencil(i);
    for (std::size_t k = 0; k < line.size(); ++k) {
      const double across = line[k].row * std::cos(angle) - line[k].col * std::sin(angle);
      EXPECT_LE(std::abs(across), 0.51) << i;
      if (k == 0) continue;
      const int step = std::max(std::abs(line[k].col - line[k - 1].col), std::abs(line[k].row - line[k - 1].row));
      EXPECT_EQ(step, 1) << i;
    }
    const double long_way = std::hypot(line.back().col - line.front().col, line.back().row - line.front().row);
    EXPECT_NEAR(long_way, 15.0, 1.0) << i;
  }
}

TEST(RoadRemainder, GivesOfAPieceWhatIsThereAndKeepsTheRest) {
  CellArray cells(5, 1, kNoRoad);
  cells.at(1, 0) = 120;
  cells.at(2, 0) = 60;
  cells.at(3, 0) = kUnobserved;
  RoadRemainder rest(cells, kBase);
  const std::vector<CellOffset> piece{{-1, 0}, {0, 0}, {1, 0}, {2, 0}, {0, 1}};
  EXPECT_EQ(rest.highest(), 100);
  EXPECT_EQ(rest.share(piece, {1, 0}, 70), 70 + 40) << "at most the level of each cell; nothing outside";
  rest.take(piece, {1, 0}, 70);
  EXPECT_EQ(rest.at(1, 0), 30);
  EXPECT_EQ(rest.at(2, 0), 0) << "never below nothing";
  EXPECT_EQ(rest.at(3, 0), 0);
  EXPECT_EQ(rest.at(7, 7), 0);
}

TEST(FindLines, FindsAStraightRoadInItsDirectionAndNothingBesideIt) {
  for (const double degrees : {0.0, 17.0, 45.0, 90.0, 133.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const LineHints hints = find_lines(road_at(angle), kBase);
    EXPECT_EQ(hints.level, (kRoadValue - kBase) / 3);
    ASSERT_FALSE(hints.lines.empty());
    double along = 0.0;
    for (const LineHint& hint : hints.lines) {
      EXPECT_LE(std::abs(hint.row * std::cos(angle) - hint.col * std::sin(angle)), 1.0) << degrees;
      along += std::cos(2.0 * (hint.angle - angle));
    }
    EXPECT_GT(along / static_cast<double>(hints.lines.size()), 0.9) << degrees;
  }
}

TEST(FindLines, TakesNoMoreThanIsThere) {
  const FeatureMap road = road_at(0.4);
  RoadRemainder rest(road.cells, kBase);
  const LineHints hints = find_lines(road, kBase);
  for (const LineHint& hint : hints.lines) {
    const auto direction = static_cast<int>(std::lround(hint.angle * kLineDirections / std::numbers::pi));
    const CellOffset at{static_cast<int>(std::floor(hint.col + road.nadir.col)),
                        static_cast<int>(std::floor(hint.row + road.nadir.row))};
    const auto& line = line_stencil(direction);
    EXPECT_GE(rest.share(line, at, hints.level), 0.4 * hints.level * static_cast<double>(line.size()));
    rest.take(line, at, hints.level);
  }
  int left = 0;
  int before = 0;
  for (const Cell cell : road.cells.cells()) before += std::max(0, cell - kBase);
  for (int row = 0; row < rest.rows(); ++row) {
    for (int col = 0; col < rest.cols(); ++col) left += rest.at(col, row);
  }
  EXPECT_LT(left, before / 5) << "most of the road";
}

TEST(FindLines, FindsNoneWhereNoRoadIs) {
  EXPECT_TRUE(find_lines(FeatureMap::centred(CellArray(kSeenSide, kSeenSide, kNoRoad), 4.0), kBase).lines.empty());
  EXPECT_TRUE(find_lines(FeatureMap::centred(CellArray(kSeenSide, kSeenSide), 4.0), kBase).lines.empty());
}

}  // namespace
}  // namespace roadfix
