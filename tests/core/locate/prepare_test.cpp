#include "core/locate/prepare.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace roadfix
