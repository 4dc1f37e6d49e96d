#include "core/locate/prepare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

TEST(InCellsOf, TakesANadirAsFarOffAsItsHeadingsAreSearchedForAndNoFarther) {
  const GridBox city{{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}};
  const MapView map{"city", "1", UtmZone::from_epsg(32637).value(), 0.25, city, 0.0, {}};
  const auto code = [&](int side, double nadir_row) {
    FeatureMap features = FeatureMap::centred(CellArray(side, side, kNoRoad), map.cell_m);
    features.nadir.row = nadir_row;
    return testing::code_of([&] { in_cells_of(map, features); });
  };
  EXPECT_EQ(code(100, 350.0), "no error");
  EXPECT_EQ(code(100, 351.0), "nadir-out-of-range");
  EXPECT_EQ(code(100, -251.0), "nadir-out-of-range");
  EXPECT_EQ(code(100, std::nan("")), "nadir-out-of-range");
  EXPECT_EQ(code(4000, 7300.0), "no error");
  EXPECT_EQ(code(4000, 7400.0), "nadir-out-of-range") << "more cells of the map than are read around a pose";
}

}  // namespace
}  // namespace roadfix
