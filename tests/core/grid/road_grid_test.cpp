#include "core/grid/road_grid.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(RoadGrid, TellsTheCellThatHoldsAPoint) {
  RoadGrid grid = RoadGrid::unobserved(GridGeometry::covering({{0, 0}, {4, 4}}, 2.0));
  grid.cells.at(0, 0) = kNoRoad;
  EXPECT_EQ(grid.cell_at({0.0, 2.1}), kNoRoad) << "north-west";
  EXPECT_EQ(grid.cell_at({1.9, 4.0}), kNoRoad);
  EXPECT_EQ(grid.cell_at({2.0, 3.0}), kUnobserved) << "an edge belongs to the cell east of it";
  EXPECT_EQ(grid.cell_at({1.0, 2.0}), kUnobserved) << "or south of it";
  EXPECT_EQ(grid.cell_at({-0.1, 3.0}), kUnobserved) << "outside";
}

}  // namespace
}  // namespace roadfix
