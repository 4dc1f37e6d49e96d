#include "core/grid/geometry.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(GridGeometry, CoversABoxOnTheLattice) {
  const GridGeometry g = GridGeometry::covering({{100.5, 200.5}, {103.0, 206.1}}, 2.0);
  EXPECT_EQ(g.box().min, (GridPoint{100, 200}));
  EXPECT_EQ(g.box().max, (GridPoint{104, 208}));
  EXPECT_EQ(g.cols, 2);
  EXPECT_EQ(g.rows, 4);
}

TEST(GridGeometry, FirstRowIsTheNorthernOne) {
  const GridGeometry g = GridGeometry::covering({{0, 0}, {4, 4}}, 2.0);
  EXPECT_EQ(g.cell_center(0, 0), (GridPoint{1, 3}));
  const auto p = g.position_of({1, 3});
  EXPECT_EQ(p.col, 0.5);
  EXPECT_EQ(p.row, 0.5);
}

TEST(GridGeometry, IntersectsWithANeighbour) {
  const GridGeometry a = GridGeometry::covering({{0, 0}, {8, 8}}, 1.0);
  const GridGeometry b = GridGeometry::covering({{6, 2}, {20, 20}}, 1.0);
  EXPECT_EQ(a.intersection(b)->box().min, (GridPoint{6, 2}));
  EXPECT_EQ(a.intersection(b)->box().max, (GridPoint{8, 8}));
  EXPECT_FALSE(a.intersection(GridGeometry::covering({{8, 0}, {9, 9}}, 1.0)));
}

TEST(GridGeometry, IsPaddedOnEverySide) {
  const GridGeometry padded = GridGeometry{2.0, {5, -7}, 3, 4}.padded(2);
  EXPECT_EQ(padded, (GridGeometry{2.0, {3, -9}, 7, 8}));
}

TEST(GridGeometry, KnowsTheCellSizesOfMaps) {
  for (const double good : {0.25, 0.5, 1.0, 2.0, 16.0}) EXPECT_TRUE(is_map_cell_size(good));
  for (const double bad : {0.125, 3.0, 32.0, 0.0, -2.0}) EXPECT_FALSE(is_map_cell_size(bad));
}

}  // namespace
}  // namespace roadfix
