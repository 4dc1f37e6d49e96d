// How far rasters lie off is compared with how far off they were put.
#include "tiles/imagery/position_error.hpp"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <optional>
#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/place.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/imagery/geotransform.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using testing::kZone;
using testing::write_raster;

/// Pixels of 0.0001 degrees, about 11 m to the north.
constexpr double kPixelDeg = 1e-4;
constexpr int kPixels = 100;

class NitfPosition : public ::testing::Test {
 protected:
  /// A copy of a raster with this northern edge.
  std::string copied(double north_deg, const CPLStringList& creation) const {
    const std::string original = write_raster(folder / "a.tif",
                                              {.width = kPixels,
                                               .height = kPixels,
                                               .epsg = 4326,
                                               .transform = {{38.26, kPixelDeg, 0.0, north_deg, 0.0, -kPixelDeg}}},
                                              [](int, int col, int) { return col; });
    std::string copy = folder / "a.ntf";
    const DatasetPtr from(open_dataset(original, GDAL_OF_RASTER));
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("NITF");
    const DatasetPtr to(driver->CreateCopy(copy.c_str(), from.get(), FALSE, creation.List(), nullptr, nullptr));
    return copy;
  }

  testing::TemporaryFolder folder;
};

TEST_F(NitfPosition, IsAsUncertainAsItsCornersAreRounded) {
  constexpr double kDegreeM = 111'000.0;
  for (const char* coordinates : {"G", "D"}) {
    CPLStringList creation;
    creation.SetNameValue("ICORDS", coordinates);
    constexpr int kPlaces = 40;
    double squares = 0.0;
    std::optional<PositionError> told;
    for (int i = 0; i < kPlaces; ++i) {
      const double north_deg = 37.76 + i * 0.0173 / kPlaces;
      const RasterFile file(copied(north_deg, creation), {});
      squares += std::pow((geotransform_of(file.dataset()).value()[3] - north_deg) * kDegreeM, 2);
      told = position_errors(file, kZone).placing;
    }
    EXPECT_NEAR(told->sigma_m / std::sqrt(squares / kPlaces), 1.0, 0.2) << coordinates;
    EXPECT_THAT(told->reason, ::testing::HasSubstr("as NITF it tells its corners to a "));
  }
}

TEST_F(NitfPosition, IsExactWhereItsCornersAreToldAgain) {
  constexpr double kNorthDeg = 37.7613;
  const double half = kPixelDeg / 2.0;
  const double span = (kPixels - 1) * kPixelDeg;
  const auto corner = [&](double east, double south) {
    return fmt::format("+{:09.6f}+{:010.6f}", kNorthDeg - half - south * span, 38.26 + half + east * span);
  };
  CPLStringList creation;
  creation.SetNameValue("ICORDS", "D");
  creation.SetNameValue("BLOCKA_BLOCK_COUNT", "01");
  creation.SetNameValue("BLOCKA_BLOCK_INSTANCE_01", "01");
  creation.SetNameValue("BLOCKA_L_LINES_01", fmt::format("{:05}", kPixels).c_str());
  creation.SetNameValue("BLOCKA_FRFC_LOC_01", corner(0.0, 0.0).c_str());
  creation.SetNameValue("BLOCKA_FRLC_LOC_01", corner(1.0, 0.0).c_str());
  creation.SetNameValue("BLOCKA_LRFC_LOC_01", corner(0.0, 1.0).c_str());
  creation.SetNameValue("BLOCKA_LRLC_LOC_01", corner(1.0, 1.0).c_str());
  const RasterFile file(copied(kNorthDeg, creation), {});
  EXPECT_NEAR(geotransform_of(file.dataset()).value()[3], kNorthDeg, 2e-6);
  EXPECT_EQ(position_errors(file, kZone).placing.sigma_m, 0.0);
}

}  // namespace
}  // namespace roadfix
