#include "core/locate/same_view.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

FeatureMap road_at(int col) {
  CellArray cells(20, 20, kNoRoad);
  for (int row = 0; row < 20; ++row) cells.at(col, row) = kRoad;
  return FeatureMap::centred(cells, 2.0);
}

TEST(SameView, IsOneOfTheSameRoadsInCellsOfTheSameSize) {
  EXPECT_TRUE(is_same_view(road_at(3), road_at(3)));
  EXPECT_FALSE(is_same_view(road_at(3), road_at(4)));
  FeatureMap larger = road_at(3);
  larger.cell_m = 3.0;
  EXPECT_FALSE(is_same_view(road_at(3), larger));
}

TEST(SameView, IsNoneOfTwoWoods) {
  const FeatureMap wood = FeatureMap::centred(CellArray(20, 20, kNoRoad), 2.0);
  EXPECT_FALSE(is_same_view(wood, wood));
}

TEST(SameView, NeedsAMoveOfAMetreOrATurnOfHalfADegreeToBeWrong) {
  EXPECT_FALSE(has_moved(0.9, Angle::degrees(0.5).radians()));
  EXPECT_TRUE(has_moved(1.1, 0.0));
  EXPECT_TRUE(has_moved(0.0, Angle::degrees(0.6).radians()));
}

}  // namespace
}  // namespace roadfix
