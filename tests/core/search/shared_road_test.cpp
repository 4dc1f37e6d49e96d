#include "core/search/shared_road.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/ascii_map.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;

constexpr StraightRoad kLine{.width = 1.0, .apart = 0.0};

/// Of a map that is seen as it is.
double beside_two_lines(const CellArray& map) { return road_beside_straight_ones(map, map, 2, kLine, 1.0); }

TEST(SharedRoad, IsWhatMapAndFeaturesHaveInCommonBesideTwoStraightLines) {
  const CellArray map = from_ascii(R"(
    ...#..............
    ...#..............
    ##################
    ...#..............
    ...#..............
    ...#..............
    ...#....##########
    ...#..............
    ...#..............)");
  const CellArray features = from_ascii(R"(
    ...#......#.......
    ...#......#.......
    ##################
    ...#..............
    ...#..............
    ...#..............
    ...#...........###
    ...#..............
    ...#..............)");
  EXPECT_NEAR(beside_two_lines(map), 7.0, 1e-9) << "of the shortest, without its crossings";
  EXPECT_NEAR(road_beside_straight_ones(map, features, 2, kLine, 1.0), 3.0, 1e-9);
}

TEST(SharedRoad, DoesNotDependOnHowSureADetectorIs) {
  const CellArray map = from_ascii(R"(
    ##########
    ..........
    ..........
    ..........
    ..........
    ##########
    ..........
    ..........
    ..........
    ..........
    .######...
    ..........)");
  CellArray faint = map;
  for (Cell& cell : faint.cells()) cell = cell_from_probability(is_road(cell) ? 0.3 : 0.1);
  EXPECT_NEAR(beside_two_lines(map), 6.0, 1e-9);
  EXPECT_NEAR(road_beside_straight_ones(map, faint, 2, kLine, 1.0), 6.0, 1e-9);
}

TEST(SharedRoad, OfRoadsThatDoNotMeetIsNothing) {
  EXPECT_EQ(road_beside_straight_ones(from_ascii("#...."), from_ascii("...#."), 2, kLine, 1.0), 0.0);
  EXPECT_EQ(road_beside_straight_ones(from_ascii("....."), from_ascii("...#."), 2, kLine, 1.0), 0.0);
  EXPECT_EQ(road_beside_straight_ones(from_ascii("????"), from_ascii("##.."), 2, kLine, 1.0), 0.0);
}

TEST(SharedRoad, LeavesOutWhatWasNotObservedInBoth) {
  const CellArray map = from_ascii(R"(
    ##########
    ..........
    ..........
    ..........
    ..........
    ##########
    ..........
    ..........
    ..........
    ..........
    .######...)");
  CellArray features = map;
  for (int col = 0; col < 3; ++col) features.at(col, 10) = kUnobserved;
  EXPECT_NEAR(road_beside_straight_ones(map, features, 2, kLine, 1.0), 4.0, 1e-9);
}

TEST(SharedRoad, IsAsLongAsTheRoadIsThatRunsAcrossTheCells) {
  CellArray map(80, 80, kNoRoad);
  for (int row = 0; row < 80; ++row) {
    for (int col = std::max(0, row - 2); col <= std::min(79, row + 2); ++col) map.at(col, row) = kRoad;
  }
  EXPECT_NEAR(road_beside_straight_ones(map, map, 0, kLine, 1.0), 80.0 * std::numbers::sqrt2, 3.0);
}

TEST(SharedRoad, LeavesOutRoadsLessThanHalfAsSureAsThoseThatTheAgreementRestsOn) {
  CellArray map(40, 40, kNoRoad);
  for (int col = 0; col < 40; ++col) {
    map.at(col, 5) = map.at(col, 15) = kRoad;
    map.at(col, 25) = cell_from_probability(0.8);
    map.at(col, 35) = cell_from_probability(0.6);
  }
  EXPECT_NEAR(road_beside_straight_ones(map, map, 0, kLine, 1.0), 120.0, 1e-9);
}

TEST(SharedRoad, BesideAStraightRoadIsOneThatIsLessThanHalfAsLongHoweverNear) {
  for (const auto& [length, left] : {std::pair(12, 12.0), {28, 0.0}}) {
    CellArray map(40, 40, kNoRoad);
    for (int col = 0; col < 40; ++col) map.at(col, 10) = kRoad;
    for (int col = 0; col < length; ++col) map.at(col, 13) = kRoad;
    EXPECT_NEAR(road_beside_straight_ones(map, map, 1, {.width = 1.0, .apart = 4.0}, 1.0), left, 1e-9) << length;
  }
}

TEST(SharedRoad, IsNoLongerOfARoadThatIsSeenBesideItself) {
  CellArray map(40, 40, kNoRoad);
  CellArray features(40, 40, kNoRoad);
  for (int col = 0; col < 40; ++col) {
    for (int width = 0; width < 3; ++width) {
      for (const int row : {2, 12}) map.at(col, row + width) = features.at(col, row + width) = kRoad;
      map.at(col, 30 + width) = kRoad;
      features.at(col, 32 + width) = kRoad;
    }
  }
  EXPECT_NEAR(road_beside_straight_ones(map, features, 2, {4.0, 0.0}, 3.0), 40.0 / 3.0, 1e-9);
}

struct Piece {
  double x, y;  ///< from the middle of the square
  double deg;
  double length;
};

constexpr int kSide = 160;

/// Straight pieces of road in a square.
CellArray drawn(const std::vector<Piece>& pieces, double width) {
  CellArray map(kSide, kSide, kNoRoad);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      for (const Piece& piece : pieces) {
        const double x = col + 0.5 - kSide / 2.0 - piece.x;
        const double y = row + 0.5 - kSide / 2.0 - piece.y;
        const double angle = piece.deg * std::numbers::pi / 180.0;
        const double along = x * std::cos(angle) + y * std::sin(angle);
        const double beside = std::abs(y * std::cos(angle) - x * std::sin(angle));
        if (along >= 0.0 && along <= piece.length && beside <= 0.5 * width) map.at(col, row) = kRoad;
      }
    }
  }
  return map;
}

class SharedRoadOf : public ::testing::TestWithParam<double> {
 protected:
  /// Sides of the square that are left at most, or at least, however the pieces are turned.
  std::pair<double, double> sides_left(const std::vector<Piece>& pieces) const {
    double least = 10.0;
    double most = 0.0;
    for (const double turn : {0.0, 13.0, 30.0, 45.0}) {
      std::vector<Piece> turned = pieces;
      for (Piece& piece : turned) {
        const double angle = turn * std::numbers::pi / 180.0;
        piece = {piece.x * std::cos(angle) - piece.y * std::sin(angle),
                 piece.x * std::sin(angle) + piece.y * std::cos(angle), piece.deg + turn, piece.length};
      }
      const CellArray map = drawn(turned, GetParam());
      const double left = road_beside_straight_ones(map, map, 2, {10.0, 20.0}, 3.0) / kSide;
      least = std::min(least, left);
      most = std::max(most, left);
    }
    return {least, most};
  }
};

TEST_P(SharedRoadOf, AJunctionOfStraightRoadsIsNoneOrAThirdArm) {
  constexpr double kFar = 2.0 * kSide;
  EXPECT_LT(sides_left({{-kFar, 0, 0, 2 * kFar}}).second, 0.05) << "a straight road";
  EXPECT_LT(sides_left({{-kFar, 0, 0, 2 * kFar}, {0, 0, 90, kFar}}).second, 0.05) << "T";
  EXPECT_LT(sides_left({{-kFar, 0, 0, 2 * kFar}, {0, -kFar, 90, 2 * kFar}}).second, 0.05) << "X";
  EXPECT_LT(sides_left({{0, 0, 0, kFar}, {0, 0, 120, kFar}, {0, 0, 240, kFar}}).second, 0.65) << "Y";
}

TEST_P(SharedRoadOf, ACrossingOfTwoCarriagewaysIsThatOfOneRoad) {
  constexpr double kFar = 2.0 * kSide;
  const Piece one{-kFar, 0, 0, 2 * kFar};
  for (const double apart : {11.0, 15.0, 19.0}) {
    const Piece other{-kFar, apart, 0, 2 * kFar};
    EXPECT_LT(sides_left({one, other, {0, -kFar, 80, 2 * kFar}}).second, 0.05) << "an overpass, " << apart;
    EXPECT_LT(sides_left({one, other, {0, -kFar, 80, 2 * kFar}, {apart, -kFar, 80, 2 * kFar}}).second, 0.2) << apart;
  }
}

TEST_P(SharedRoadOf, AParallelStreetFartherAwayIsAnother) {
  constexpr double kFar = 2.0 * kSide;
  EXPECT_GT(sides_left({{-kFar, 0, 0, 2 * kFar}, {-kFar, 40, 0, 2 * kFar}, {0, -kFar, 80, 2 * kFar}}).first, 0.4);
}

TEST_P(SharedRoadOf, StreetsThatTellAPlaceIsMoreThanAnotherRoadAcross) {
  const std::vector<Piece> streets{
      {-70, -50, 0, 140}, {-70, 40, 7, 140}, {-45, -60, 90, 120}, {5, -50, 80, 90}, {50, -50, 95, 110}};
  EXPECT_GT(sides_left(streets).first, 1.2);
}

INSTANTIATE_TEST_SUITE_P(Width, SharedRoadOf, ::testing::Values(3.0, 4.0, 6.0, 8.0));

}  // namespace
}  // namespace roadfix
