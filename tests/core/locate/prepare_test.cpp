#include "core/locate/prepare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

const MapView kCity{{"city", "1"},
                    UtmZone::from_epsg(32637).value(),
                    0.25,
                    {{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}},
                    {},
                    {},
                    {}};

TEST(InCellsOf, TakesANadirAsFarOffAsItsHeadingsAreSearchedForAndNoFarther) {
  const auto code = [&](int side, double nadir_row) {
    FeatureMap features = FeatureMap::centred(CellArray(side, side, kNoRoad), kCity.cell_m);
    features.nadir.row = nadir_row;
    return testing::code_of([&] { in_cells_of(kCity, features); });
  };
  EXPECT_EQ(code(100, 350.0), "no error");
  EXPECT_EQ(code(100, 351.0), "nadir-out-of-range");
  EXPECT_EQ(code(100, -251.0), "nadir-out-of-range");
  EXPECT_EQ(code(100, std::nan("")), "nadir-out-of-range");
  EXPECT_EQ(code(4000, 7300.0), "no error");
  EXPECT_EQ(code(4000, 7400.0), "nadir-out-of-range") << "more cells of the map than are read around a pose";
}

TEST(InCellsOf, TakesTheFarCornerThatIsLeftOfACoveredFrameForNothingSeen) {
  const auto observed = [](int side) {
    FeatureMap frame = FeatureMap::centred(CellArray(100, 100), kCity.cell_m);
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) frame.cells.at(col, row) = kNoRoad;
    }
    return in_cells_of(kCity, frame).cells.observed_count();
  };
  EXPECT_EQ(observed(40), 1600U);
  EXPECT_EQ(observed(5), 0U);
  EXPECT_EQ(observed(0), 0U);
}

/// Of what is seen as road: to the right of the nadir and behind it.
GridGeometry::CellPosition metres_to_road(const FeatureMap& features) {
  double sum = 0.0;
  GridGeometry::CellPosition at{0.0, 0.0};
  for (int row = 0; row < features.cells.rows(); ++row) {
    for (int col = 0; col < features.cells.cols(); ++col) {
      const Cell cell = features.cells.at(col, row);
      const double weight = is_observed(cell) ? probability(cell) : 0.0;
      sum += weight;
      at.col += weight * features.cell_m * (col + 0.5 - features.nadir.col);
      at.row += weight * features.cell_m * (row + 0.5 - features.nadir.row);
    }
  }
  return {at.col / sum, at.row / sum};
}

TEST(InCellsOf, LeavesRoadsWhereTheyAreSeenFromTheNadirWhateverBordersShowNothing) {
  for (const auto& [cell_m, of_map_m] : {std::pair(0.25, 0.25), {0.3, 0.25}, {0.5, 0.5}, {0.8, 0.5}}) {
    FeatureMap frame = FeatureMap::centred(CellArray(140, 100), cell_m);
    frame.nadir = {30.0, 75.0};
    for (int row = 12; row < 80; ++row) {
      for (int col = 25; col < 120; ++col) {
        frame.cells.at(col, row) = row < 36 && col >= 60 && col < 76 ? kRoad : kNoRoad;
      }
    }
    const FeatureMap prepared = in_cells_of(kCity, frame);
    EXPECT_EQ(prepared.cell_m, of_map_m) << cell_m;
    const auto [right_m, behind_m] = metres_to_road(prepared);
    EXPECT_NEAR(right_m, cell_m * (68.0 - 30.0), 0.1 * cell_m) << cell_m;
    EXPECT_NEAR(behind_m, cell_m * (24.0 - 75.0), 0.1 * cell_m) << cell_m;
    EXPECT_NEAR(prepared.cell_m * prepared.cells.cols(), cell_m * 95.0, 2.0 * prepared.cell_m) << cell_m;
    EXPECT_NEAR(prepared.cell_m * prepared.cells.rows(), cell_m * 68.0, 2.0 * prepared.cell_m) << cell_m;
  }
}

}  // namespace
}  // namespace roadfix
