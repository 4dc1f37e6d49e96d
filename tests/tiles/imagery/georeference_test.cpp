#include "tiles/imagery/georeference.hpp"

#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <string>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/imagery/raster_file.hpp"
#include "tiles/sources/fingerprint.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::write_raster;

class GeoreferenceTest : public ::testing::Test {
 protected:
  static double grey(int, int, int) { return 10.0; }
  testing::TemporaryFolder folder;
};

TEST_F(GeoreferenceTest, WithoutGeoreferenceItSaysWhatToDo) {
  const std::string path = write_raster(folder / "a.tif", {.epsg = 0, .transform = std::nullopt}, grey);
  EXPECT_EQ(code_of([&] { RasterFile(path, {}); }), "image-without-georeference");
}

TEST_F(GeoreferenceTest, ColumnsAndRowsAreNoCoordinates) {
  for (const double down : {1.0, -1.0}) {
    const std::array<double, 6> identity{0, 1, 0, 0, 0, down};
    const std::string path = write_raster(folder / "a.tif", {.transform = identity}, grey);
    EXPECT_EQ(code_of([&] { RasterFile(path, {}); }), "image-without-georeference");
  }
  const std::array<double, 6> at_the_origin{0, 2, 0, 0, 0, -2};
  EXPECT_NO_THROW(RasterFile(write_raster(folder / "a.tif", {.transform = at_the_origin}, grey), {}));
}

TEST_F(GeoreferenceTest, LiesWhereVectorsOfItsReferenceSystemLieWhateverTheirPrimeMeridian) {
  struct Place {
    int epsg;
    double lat_deg;
    double lon_deg;
  };
  for (const auto& [epsg, lat_deg, lon_deg] :
       {Place{31288, 47.2, 10.7}, Place{20790, 39.5, -7.9}, Place{27391, 60.5, 6.0}, Place{27572, 46.7, -3.5},
        Place{26986, 42.4, -71.1}, Place{2154, 46.7, -3.5}}) {
    OGRSpatialReference crs;
    crs.importFromEPSG(epsg);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    double x = lon_deg;
    double y = lat_deg;
    ASSERT_TRUE(transformation(wgs84_reference(), crs, "")->Transform(1, &x, &y));
    const std::array<double, 6> around{x - 32.0, 1.0, 0.0, y + 32.0, 0.0, -1.0};
    const LatLon centre =
        centre_of(RasterFile(write_raster(folder / "a.tif", {.epsg = epsg, .transform = around}, grey), {}));
    EXPECT_NEAR(centre.lat_deg, lat_deg, 1e-5) << epsg;
    EXPECT_NEAR(centre.lon_deg, lon_deg, 1e-5) << epsg;
  }
}

TEST_F(GeoreferenceTest, DegreesAreNotTakenForMetres) {
  const auto code_where = [&](const std::array<double, 6>& transform) {
    const std::string path = write_raster(folder / "a.tif", {.transform = transform}, grey);
    return code_of([&] { centre_of(RasterFile(path, {})); });
  };
  EXPECT_EQ(code_where({38.26, 5e-6, 0, 37.76, 0, -5e-6}), "degrees-as-metres");
  EXPECT_EQ(code_where({38.26, 0.05, 0, 37.76, 0, -0.05}), "no error")
      << "a site of a few metres around its own origin";
}

TEST_F(GeoreferenceTest, AWorldFileNeedsAReferenceSystemFromTheUser) {
  const std::string path = write_raster(folder / "a.tif", {.epsg = 0, .transform = std::nullopt}, grey);
  std::ofstream(folder / "a.tfw") << "2\n0\n0\n-2\n400001\n4200127\n";
  EXPECT_EQ(code_of([&] { RasterFile(path, {}); }), "image-without-georeference");
  EXPECT_THAT(testing::message_of([&] { RasterFile(path, {}); }), ::testing::HasSubstr("--crs of ingest"))
      << "other commands, which have no such option, read rasters too";
  EXPECT_EQ(crs_name(RasterFile(path, {.crs = "EPSG:32637", .collar = {}}).crs()), "EPSG:32637");
  EXPECT_EQ(code_of([&] { RasterFile(path, {.crs = "EPSG:nonsense", .collar = {}}); }), "crs-unknown");
}

TEST_F(GeoreferenceTest, AWorldFileIsFoundAmongMoreFilesThanGdalLists) {
  for (int i = 0; i < 1100; ++i) std::ofstream(folder / std::to_string(i));
  const std::string path = write_raster(folder / "a.tif", {.epsg = 0, .transform = std::nullopt}, grey);
  const RasterOptions options{.crs = "EPSG:32637", .collar = {}};
  for (const int east_m : {400001, 500001}) {
    std::ofstream(folder / "a.tfw") << "2\n0\n0\n-2\n" << east_m << "\n4200127\n";
    EXPECT_NEAR(centre_of(RasterFile(path, options)).lon_deg, east_m == 500001 ? 39.0 : 37.86, 0.01);
  }
  const std::string before = fingerprint({path}, "");
  std::ofstream(folder / "a.tfw") << "2\n0\n0\n-2\n400001\n4200127\n";
  EXPECT_NE(fingerprint({path}, ""), before);
}

TEST_F(GeoreferenceTest, PixelsWithoutAreaAreNotBlamedOnTheReferenceSystem) {
  const std::array<double, 6> flat{400000, 2, 0, 4200000, 0, 0};
  const std::array<double, 6> parallel{400000, 2, 2, 4200000, -2, -2};
  for (const auto& transform : {flat, parallel}) {
    const std::string path = write_raster(folder / "a.tif", {.transform = transform}, grey);
    const RasterFile file(path, {});
    EXPECT_EQ(code_of([&] { Georeference(file, *UtmZone::from_epsg(32637)); }), "image-without-georeference");
    EXPECT_THAT(testing::message_of([&] { centre_of(file); }),
                ::testing::HasSubstr("gives its pixels no area, so that nothing says where they lie"));
  }
}

TEST_F(GeoreferenceTest, ControlPointsThatNothingFitsAreNotBlamedOnTheReferenceSystem) {
  const auto message_where = [&](const std::vector<std::array<double, 2>>& places) {
    testing::RasterSpec spec;
    for (const auto& [col, row] : places) spec.control_points.push_back({col, row, 400000.0 + col, 4200064.0 - row});
    const RasterFile file(write_raster(folder / "a.tif", spec, grey), {});
    return testing::message_of([&] { centre_of(file); });
  };
  EXPECT_EQ(message_where({{0, 0}, {64, 0}, {0, 64}, {64, 64}}), "no error");
  EXPECT_THAT(message_where({{0, 0}, {32, 32}, {64, 64}}), ::testing::HasSubstr("its 3 control points lie so that"));
  EXPECT_THAT(message_where({{0, 0}, {32, 0}, {64, 0}, {0, 64}, {32, 64}, {64, 64}}),
              ::testing::HasSubstr("gdalwarp -order 1"))
      << "two lines";
}

TEST_F(GeoreferenceTest, AWorldFileMayHaveItsReferenceSystemInAPrjFile) {
  const std::string path = write_raster(folder / "a.tif", {.epsg = 0, .transform = std::nullopt}, grey);
  std::ofstream(folder / "a.tfw") << "2\n0\n0\n-2\n400001\n4200127\n";
  std::ofstream(folder / "a.prj") << "nonsense";
  EXPECT_EQ(code_of([&] { RasterFile(path, {}); }), "crs-unknown");
  EXPECT_THAT(testing::message_of([&] { RasterFile(path, {}); }),
              ::testing::HasSubstr((folder / "a.prj").string() + ": holds no reference system"));
  const std::string nonsense = fingerprint({path}, "");
  std::ofstream(folder / "a.prj")
      << R"(PROJCS["WGS_1984_UTM_Zone_37N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,)"
      << R"(298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],)"
      << R"(PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],)"
      << R"(PARAMETER["Central_Meridian",39.0],PARAMETER["Scale_Factor",0.9996],)"
      << R"(PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]])";
  const OGRSpatialReference utm = utm_reference(*UtmZone::from_epsg(32637));
  EXPECT_TRUE(RasterFile(path, {}).crs().IsSame(&utm));
  EXPECT_EQ(crs_name(RasterFile(path, {.crs = "EPSG:32633", .collar = {}}).crs()), "EPSG:32633");
  EXPECT_NE(fingerprint({path}, ""), nonsense);
  for (const char* format : {"FORMAT=WKT2_2019", "FORMAT=WKT1_ESRI"}) {
    char* text = nullptr;
    const char* const options[] = {format, "MULTILINE=YES", nullptr};
    utm.exportToWkt(&text, options);
    std::ofstream(folder / "a.prj") << '\n' << text;
    CPLFree(text);
    EXPECT_TRUE(RasterFile(path, {}).crs().IsSame(&utm)) << format;
  }
  std::ofstream(folder / "a.tfw") << "2\n0\n0\n-2\n4200127\n400001\n";
  EXPECT_EQ(code_of([&] { centre_of(RasterFile(path, {})); }), "axes-swapped") << "its WKT has no codes";
}

TEST_F(GeoreferenceTest, ControlPointsAreNotTakenForMetresOrTheRightWayRoundWhereTheyAreNot) {
  const auto code_where = [&](int epsg, double x, double y, double pixel) {
    testing::RasterSpec spec{.epsg = epsg};
    for (const double row : {0.0, 64.0}) {
      for (const double col : {0.0, 64.0}) spec.control_points.push_back({col, row, x + pixel * col, y - pixel * row});
    }
    const std::string path = write_raster(folder / "a.tif", spec, grey);
    return code_of([&] { centre_of(RasterFile(path, {})); });
  };
  EXPECT_EQ(code_where(32637, 400'000, 4'200'000, 0.5), "no error");
  EXPECT_EQ(code_where(32637, 4'200'000, 400'000, 0.5), "axes-swapped");
  EXPECT_EQ(code_where(32637, 38.26, 37.76, 5e-6), "degrees-as-metres");
  EXPECT_EQ(code_where(4326, 38.26, 37.76, 5e-6), "no error");
}

TEST_F(GeoreferenceTest, SwappedEastingAndNorthingAreRefused) {
  const auto code_where = [&](int epsg, double east_m, double north_m) {
    const std::array<double, 6> transform{east_m, 0.5, 0, north_m, 0, -0.5};
    const std::string path = write_raster(folder / "a.tif", {.epsg = epsg, .transform = transform}, grey);
    return code_of([&] { centre_of(RasterFile(path, {})); });
  };
  EXPECT_EQ(code_where(32637, 4'200'000, 400'000), "axes-swapped");
  EXPECT_EQ(code_where(32637, 400'000, 4'200'000), "no error");
  EXPECT_EQ(code_where(32637, 1'400'000, 4'200'000), "no error") << "beyond the rim of a zone";
  EXPECT_EQ(code_where(32760, 8'200'000, 250'000), "axes-swapped") << "a zone that ends at the 180th meridian";
  EXPECT_EQ(code_where(31467, 5'500'000, 3'500'000), "axes-swapped");
  EXPECT_EQ(code_where(3857, 4'600'000, 4'250'000), "no error") << "a system for the whole Earth";
}

}  // namespace
}  // namespace roadfix
