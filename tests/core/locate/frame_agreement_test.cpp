#include "core/locate/frame_agreement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/ascii_map.hpp"

namespace roadfix {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kCellM = 10.0;

const CellArray kStreets = testing::from_ascii(R"(
  ..#.....
  ..#.....
  ########
  ..#...#.
  ..#...#.
  ..#...#.
  ..#...#.
  ..#...##
  ..####..
  .....#..
  .....#..
  .....#..)");
const CellArray kOtherStreets = testing::from_ascii(R"(
  .......#
  .......#
  ......#.
  ......#.
  #######.
  #.......
  #.......
  #.......
  #.......
  .#......
  .#......
  .#......)");

/// A frame of 80 x 80 m that was taken so many cells ahead of where the ground's last rows are seen.
FeatureMap seen(const CellArray& ground, int ahead) {
  CellArray cells(8, 8);
  paste(ground, cells, 0, ahead - 4);
  return FeatureMap::centred(cells, kCellM);
}

BodyOffset at(int ahead) { return {kCellM * ahead, 0.0, {}}; }

PlacedFeatures right(int ahead) { return {seen(kStreets, ahead), at(ahead)}; }
PlacedFeatures of_another_place(int ahead) { return {seen(kOtherStreets, ahead), at(ahead)}; }
/// Told to have been taken 20 m farther right and 10 m farther back than it was.
PlacedFeatures strayed(int ahead) { return {seen(kStreets, ahead), {kCellM * (ahead - 1), 20.0, {}}}; }

std::vector<std::size_t> contradicting(const std::vector<PlacedFeatures>& parts) { return contradicting_frames(parts); }

TEST(ContradictingFrames, AreNoneOfAFlight) {
  EXPECT_THAT(contradicting({right(0), right(1), right(2), right(4)}), IsEmpty());
  PlacedFeatures turned = right(2);
  turned.features = seen(kStreets, 2);
  for (int row = 0; row < 8; ++row) {
    for (int col = 0; col < 8; ++col) turned.features.cells.at(col, row) = right(2).features.cells.at(7 - col, 7 - row);
  }
  turned.offset.turn = Angle::degrees(180.0);
  EXPECT_THAT(contradicting({right(0), turned, right(1)}), IsEmpty());
}

TEST(ContradictingFrames, AreThoseOfAnotherPlaceOrWithAnotherOffset) {
  EXPECT_THAT(contradicting({right(0), right(1), of_another_place(2)}), ElementsAre(2));
  EXPECT_THAT(contradicting({of_another_place(0), right(1), right(2)}), ElementsAre(0));
  EXPECT_THAT(contradicting({right(0), strayed(1), right(2)}), ElementsAre(1));
  EXPECT_THAT(contradicting({right(0), of_another_place(1), right(2), strayed(1), right(1)}), ElementsAre(1, 3));
}

TEST(ContradictingFrames, AreNotToldWithoutAMajority) {
  EXPECT_THAT(contradicting({right(0), of_another_place(1)}), IsEmpty());
  EXPECT_THAT(contradicting({right(0), right(1), of_another_place(0), of_another_place(1)}), IsEmpty());
  const auto far_on = [](PlacedFeatures part) {
    part.offset.forward_m += 500.0;
    return part;
  };
  EXPECT_THAT(contradicting({right(0), of_another_place(1), far_on(right(0)), far_on(right(1)), far_on(right(2))}),
              IsEmpty())
      << "one of the first two is wrong, but which?";
}

TEST(ContradictingFrames, ShowRoadsAndEnoughOfTheGroundOfOthers) {
  const PlacedFeatures bare{FeatureMap::centred(CellArray(8, 8, kNoRoad), kCellM), at(1)};
  EXPECT_THAT(contradicting({right(0), right(2), bare}), IsEmpty());
  PlacedFeatures far = of_another_place(2);
  far.offset.forward_m = 70.0;
  EXPECT_THAT(contradicting({right(0), right(1), right(2), far}), IsEmpty());
}

TEST(ContradictingFrames, AreToldOfLargePicturesByAPartOfTheirCells) {
  const auto finer = [](PlacedFeatures part) {
    constexpr int kTimes = 80;
    CellArray cells(8 * kTimes, 8 * kTimes);
    for (int row = 0; row < cells.rows(); ++row) {
      for (int col = 0; col < cells.cols(); ++col) {
        cells.at(col, row) = part.features.cells.at(col / kTimes, row / kTimes);
      }
    }
    part.features = FeatureMap::centred(cells, kCellM / kTimes);
    return part;
  };
  EXPECT_THAT(contradicting({finer(right(0)), finer(of_another_place(1)), finer(right(2))}), ElementsAre(1));
}

}  // namespace
}  // namespace roadfix
