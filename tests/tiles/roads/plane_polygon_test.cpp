#include "tiles/roads/plane_polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace roadfix {
namespace {

using Ring = std::vector<GridPoint>;

constexpr GridGeometry kCells{2.0, {100, -200}, 24, 20};

/// Whether a ray to the west crosses the rings an odd number of times.
bool contains(const std::vector<Ring>& rings, GridPoint p) {
  int crossings = 0;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const GridPoint a = ring[i];
      const GridPoint b = ring[(i + 1) % ring.size()];
      if ((a.north_m > p.north_m) == (b.north_m > p.north_m)) continue;
      const double east = a.east_m + (p.north_m - a.north_m) / (b.north_m - a.north_m) * (b.east_m - a.east_m);
      if (east <= p.east_m) ++crossings;
    }
  }
  return crossings % 2 == 1;
}

void expect_cells_of(const Ring& outer, const std::vector<Ring>& holes, const GridGeometry& block) {
  std::vector<Ring> rings = holes;
  rings.push_back(outer);
  CellArray inside(block.cols, block.rows);
  const PlanePolygon polygon(outer, holes);
  polygon.fill(block, kNoRoad, inside);
  const GridBox box = polygon.box();
  int wrong = 0;
  for (int row = 0; row < block.rows; ++row) {
    for (int col = 0; col < block.cols; ++col) {
      const bool marked = is_observed(inside.at(col, row));
      const GridPoint centre = block.cell_center(col, row);
      // Holes leave no ground beyond the outer ring.
      const bool beside = centre.north_m >= box.min.north_m && centre.north_m <= box.max.north_m;
      if (marked != (beside && contains(rings, centre))) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0) << outer.size() << " corners, row " << block.origin.row << ", cells of " << block.cell_m;
}

/// A star whose corners lie between two radii: spikes and bays.
Ring star(GridPoint centre, double low_m, double high_m, int corners, std::mt19937& random) {
  std::uniform_real_distribution<double> radius(low_m, high_m);
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const double r = radius(random);
    ring.push_back({centre.east_m + r * std::cos(angle), centre.north_m + r * std::sin(angle)});
  }
  return ring;
}

TEST(PlanePolygon, MarksCellsWhoseCentreIsInsideAndSharesNoneWithItsNeighbour) {
  const GridBox box = kCells.box();
  const GridPoint middle{box.min.east_m + 21.3, box.min.north_m + 17.7};
  const PlanePolygon left({box.min, {middle.east_m, box.min.north_m}, middle, {box.min.east_m, box.max.north_m}});
  const PlanePolygon right({{middle.east_m, box.min.north_m},
                            {box.max.east_m, box.min.north_m},
                            box.max,
                            {box.min.east_m, box.max.north_m},
                            middle});
  CellArray in_left(kCells.cols, kCells.rows);
  CellArray in_right(kCells.cols, kCells.rows);
  left.fill(kCells, kNoRoad, in_left);
  right.fill(kCells, kNoRoad, in_right);
  for (int row = 0; row < kCells.rows; ++row) {
    for (int col = 0; col < kCells.cols; ++col) {
      EXPECT_NE(in_left.at(col, row), in_right.at(col, row)) << col << ' ' << row;
    }
  }
}

TEST(PlanePolygon, EqualsCountingOfCrossingsForManyRandomPolygonsAndBlocks) {
  std::mt19937 random(11);
  const GridPoint centre{500.3, 1000.7};
  for (const int corners : {3, 4, 7, 50, 2000}) {
    for (const double low_m : {20.0, 290.0}) {
      const Ring outer = star(centre, low_m, 300.0, corners, random);
      const std::vector<Ring> holes{star({centre.east_m - 60.0, centre.north_m}, 5.0, 40.0, 30, random),
                                    star({centre.east_m + 60.0, centre.north_m + 200.0}, 10.0, 150.0, 9, random)};
      for (const double cell_m : {0.5, 4.0, 16.0}) {
        for (const double north_m : {600.0, 760.0, 1000.0, 1240.0, 1400.0}) {
          const LatticeIndex origin = lattice_index({400.0, north_m}, cell_m);
          expect_cells_of(outer, holes, {cell_m, origin, 40, 25});
        }
      }
    }
  }
}

TEST(PlanePolygon, MayHaveItsCornersAndLevelEdgesOnTheMiddlesOfCells) {
  std::mt19937 random(12);
  std::uniform_int_distribution<int> cell(-3, 27);
  for (int i = 0; i < 500; ++i) {
    Ring ring;
    for (int corner = 0; corner < 6; ++corner) ring.push_back(kCells.cell_center(cell(random), cell(random)));
    expect_cells_of(ring, {}, kCells);
  }
  expect_cells_of({kCells.cell_center(2, 5), kCells.cell_center(9, 5), kCells.cell_center(4, 5)}, {}, kCells);
}

}  // namespace
}  // namespace roadfix
