#include "core/locate/soft_map.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/grid/resample.hpp"
#include "core/locate/fix.hpp"
#include "core/locate/match_poses.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::street_map;
using testing::view_of;

/// A detector that is sure of one road cell in four.
RoadGrid doubtful_streets() {
  RoadGrid map = street_map(41, {2.0, {250'000, -3'000'000}, 500, 450});
  std::mt19937_64 random(5);
  for (Cell& cell : map.cells.cells()) {
    if (is_observed(cell)) cell = static_cast<Cell>(cell * (random() % 4 == 0 ? 0.9 : 0.3));
  }
  return map;
}

class SoftMap : public ::testing::Test {
 protected:
  RoadGrid map_ = doubtful_streets();
  MapView view_ = view_of(map_);
  const GridPose pose_{{map_.geometry.box().min.east_m + 451.3, map_.geometry.box().min.north_m + 402.9},
                       Angle::degrees(33.0)};
};

TEST_F(SoftMap, HasHalfTheLogOddsOnBothSides) {
  CellArray cells(3, 1);
  cells.at(0, 0) = cell_from_probability(0.1);
  cells.at(1, 0) = kRoad;
  const RoadGrid grid{{2.0, {0, 0}, 3, 1}, cells};
  const MapView view = view_of(grid);
  for (const CellArray& soft :
       {soft_reader(view, 2.0)(grid.geometry).cells, softened(FeatureMap::centred(cells, 2.0)).cells}) {
    EXPECT_NEAR(probability(soft.at(0, 0)), 0.25, 0.003);  // 1 : 9 becomes 1 : 3
    EXPECT_EQ(soft.at(1, 0), kRoad);
    EXPECT_EQ(soft.at(2, 0), kUnobserved);
  }
}

TEST_F(SoftMap, HoldsTheMeanOfItsFinerCellsWhereItIsCoarser) {
  for (const bool kept : {false, true}) {
    MapView view = view_;
    if (kept) view.searches = std::make_shared<SearchCache>(std::size_t{1} << 20);
    const GridReader read = soft_reader(view, 2.0);
    for (int level = 1; level <= 2; ++level) {
      // Across the borders of what is made at a time, and beyond the map.
      const int size = 1 << level;
      const LatticeIndex origin{map_.geometry.origin.col / size - 5, map_.geometry.origin.row / size - 7};
      const GridGeometry coarse{2.0 * size, origin, 200, 190};
      CellArray expected = read({2.0, {origin.col * size, origin.row * size}, 200 * size, 190 * size}).cells;
      for (int k = 0; k < level; ++k) expected = halved(expected);
      EXPECT_EQ(read(coarse).cells, expected);
      EXPECT_EQ(read(coarse).cells, expected);
    }
    if (kept) {
      EXPECT_GT(view.searches->bytes(), 0U);
    }
  }
}

TEST_F(SoftMap, IsReadOnWhereTheViewThatItCameFromReadsNoMore) {
  const GridReader read = soft_reader(view_, 2.0);
  const MapView soft = soft_view(view_);
  const CellArray before = read(map_.geometry).cells;
  view_.read = nullptr;
  EXPECT_EQ(read(map_.geometry).cells, before);
  EXPECT_EQ(soft.read(map_.geometry).cells, before);
}

TEST_F(SoftMap, LeavesEquationFiveToTheCellsAsTheyAre) {
  const FeatureMap window = cut_out(map_, pose_, 120, 90, 2.0);
  const std::vector<GeoPose> poses{on_earth(pose_, view_.zone)};
  const double matched = match(view_, window, poses).at(0).rho.value();
  EXPECT_NEAR(rho_at(view_, window, pose_).value(), matched, 1e-6);

  FeatureMap larger = window;
  larger.cell_m = 2.2;
  EXPECT_LT(rho_at(view_, resampled(larger, 2.0), pose_), 0.8 * matched);
  EXPECT_GT(rho_at(view_, resampled(larger, 2.0, 1.0 / 1.1), pose_), 0.8 * matched);

  const Fix fix = locate(view_, window, {}, {});
  ASSERT_FALSE(fix.modes.empty());
  const std::vector<GeoPose> found{fix.modes[0].pose};
  EXPECT_LT(distance_m(view_.zone.project(fix.modes[0].pose.position), pose_.position), 2.0);
  EXPECT_NEAR(fix.modes[0].rho, match(view_, window, found).at(0).rho.value(), 1e-6);
}

TEST_F(SoftMap, HasNoEquationFiveOffTheMap) {
  GridPose off = pose_;
  off.position.east_m += 5000.0;
  EXPECT_EQ(rho_at(view_, cut_out(map_, pose_, 50, 50, 2.0), off), std::nullopt);
}

}  // namespace
}  // namespace roadfix
