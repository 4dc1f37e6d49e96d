#include "core/locate/frame_parts.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "tests/support/ascii_map.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;

// In cells of 5 m, so that a half is 7200 m2.
constexpr int kSide = 24;
constexpr std::string_view kTown = R"(
  ....#.............#.....
  ....#.............#.....
  ....#.............#.....
  ########..........#.....
  ....#..##.........#.....
  ....#...##........#.....
  ....#....###############
  ....#.....##............
  ....#......##...........
  ....#.......#...........
  ....#.......#...........
  ....#.......#######.....
  ....#.......#.....##....
  #####.......#......##...
  ....#.......#.......####
  ....#.......#...........
  ....#....####...........
  ....#....#..............
  ....#....#..............
  ....######..............
  ....#....##.............
  ....#.....##............
  ....#......#############
  ....#......#............)";
constexpr std::string_view kElsewhere = R"(
  ..........#..........#..
  ..........#..........#..
  ..........#..........#..
  ..........#......#####..
  ..........#......#......
  #########.#......#......
  ........#.########......
  ........#........#......
  ........#........#......
  ........##########......
  ........#........#......
  ........#........#......
  ........#........#......
  ........#........###....
  #########..........#....
  ........#..........#....
  ........#..........#####
  ........#...............
  .....####...............
  .....#..................
  .....#...........#######
  .....#...........#......
  .....#############......
  .....#...........#......)";

/// In the rectangle of the second, the cells of the first.
void show(const CellArray& from, CellArray& in, int first_col, int first_row, int cols, int rows) {
  for (int row = first_row; row < first_row + rows; ++row) {
    for (int col = first_col; col < first_col + cols; ++col) in.at(col, row) = from.at(col, row);
  }
}

class FrameParts : public ::testing::Test {
 protected:
  RoadGrid map_{{5.0, {120'000, -1'280'000}, kSide, kSide}, from_ascii(kTown)};
  CellArray frame_ = from_ascii(kTown);
  const CellArray elsewhere_ = from_ascii(kElsewhere);

  /// Of the frame above the middle of the map, north up; "none" where no part contradicts.
  std::string contradicting() const {
    const GridPose pose{map_.geometry.box().centre(), Angle()};
    const char* part = contradicting_part(testing::view_of(map_), FeatureMap::centred(frame_, 5.0), pose);
    return part ? part : "none";
  }

  /// Likewise, of a frame of the town but for a rectangle.
  std::string contradicting_with_elsewhere_at(int first_col, int first_row, int cols, int rows) {
    frame_ = from_ascii(kTown);
    show(elsewhere_, frame_, first_col, first_row, cols, rows);
    return contradicting();
  }
};

TEST_F(FrameParts, AllFitWhereTheFrameShowsTheGround) { EXPECT_EQ(contradicting(), "none"); }

TEST_F(FrameParts, ContradictWhereAHalfShowsOtherGround) {
  constexpr int kHalf = kSide / 2;
  EXPECT_EQ(contradicting_with_elsewhere_at(0, 0, kHalf, kSide), "left half");
  EXPECT_EQ(contradicting_with_elsewhere_at(kHalf, 0, kHalf, kSide), "right half");
  EXPECT_EQ(contradicting_with_elsewhere_at(0, 0, kSide, kHalf), "upper half");
  EXPECT_EQ(contradicting_with_elsewhere_at(0, kHalf, kSide, kHalf), "lower half");
}

TEST_F(FrameParts, ContradictWhereAQuarterShowsOtherGround) {
  constexpr int kQuarter = kSide / 4;
  EXPECT_EQ(contradicting_with_elsewhere_at(0, 0, kQuarter, kSide), "left quarter");
  EXPECT_EQ(contradicting_with_elsewhere_at(kSide - kQuarter, 0, kQuarter, kSide), "right quarter");
  EXPECT_EQ(contradicting_with_elsewhere_at(0, 0, kSide, kQuarter), "upper quarter");
  EXPECT_EQ(contradicting_with_elsewhere_at(0, kSide - kQuarter, kSide, kQuarter), "lower quarter");
}

TEST_F(FrameParts, AreThoseOfTheCellsThatWereObserved) {
  show(elsewhere_, frame_, 0, 0, kSide, 9);
  show(CellArray(kSide, kSide), frame_, 0, 18, kSide, 6);
  EXPECT_EQ(contradicting(), "upper half");
}

TEST_F(FrameParts, ContradictNothingWhereTheFrameShowsTooLittleRoadInOne) {
  CellArray hidden(kSide, kSide, kNoRoad);
  hidden.at(20, 2) = kRoad;  // a speck that the map does not have
  show(hidden, frame_, kSide / 2, 0, kSide / 2, kSide);
  EXPECT_EQ(contradicting(), "none");
}

TEST_F(FrameParts, ContradictNothingWhereTheMapShowsTooLittleInOne) {
  show(elsewhere_, frame_, kSide / 2, 0, kSide / 2, kSide);
  ASSERT_EQ(contradicting(), "right half");
  for (const Cell cell : {kNoRoad, kUnobserved}) {
    show(CellArray(kSide, kSide, cell), map_.cells, kSide / 2, 0, kSide / 2, kSide);
    EXPECT_EQ(contradicting(), "none");
  }
}

}  // namespace
}  // namespace roadfix
