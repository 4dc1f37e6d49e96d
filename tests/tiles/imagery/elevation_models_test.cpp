#include "tiles/imagery/elevation_models.hpp"

#include <cpl_string.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::RasterSpec;
using testing::write_raster;

const UtmZone kZone37 = UtmZone::from_epsg(32637).value();

/// A slope that rises by a metre in 20 m to the east and by a metre in 50 m to the north.
double slope_m(GridPoint place) {
  return 700.0 + (place.east_m - 432'000.0) / 20.0 + (place.north_m - 4'180'000.0) / 50.0;
}

class ElevationModels : public ::testing::Test {
 protected:
  /// Pixels of the slope from this north-western corner on.
  static RasterSpec spec(GridPoint corner, double pixel_m, int cols, int rows) {
    return {.width = cols,
            .height = rows,
            .type = GDT_Float32,
            .epsg = 32637,
            .transform = std::array{corner.east_m, pixel_m, 0.0, corner.north_m, 0.0, -pixel_m}};
  }
  static testing::PixelFunction slope(const RasterSpec& spec) {
    const auto t = *spec.transform;
    return [t](int, int col, int row) { return slope_m({t[0] + t[1] * (col + 0.5), t[3] + t[5] * (row + 0.5)}); };
  }
  std::string write(const std::string& name, const RasterSpec& spec, const testing::PixelFunction& value) const {
    return write_raster(folder / name, spec, value);
  }
  static ElevationReading read(const std::vector<std::string>& paths, const GridGeometry& geometry = kCells) {
    return read_elevation_models(paths, kZone37, geometry);
  }
  /// The largest distance of known heights from the slope; that of unknown cells is infinite.
  static double error_m(const Terrain& terrain) {
    double worst = 0.0;
    for (int row = 0; row < terrain.geometry.rows; ++row) {
      for (int col = 0; col < terrain.geometry.cols; ++col) {
        const auto height = terrain.cell_height_m(col, row);
        if (!height) return std::numeric_limits<double>::infinity();
        worst = std::max(worst, std::abs(*height - slope_m(terrain.geometry.cell_center(col, row))));
      }
    }
    return worst;
  }

  /// 64 x 64 cells from 432,000 m east and 4,182,016 m north on.
  static constexpr GridGeometry kCells{32.0, {13'500, -130'688}, 64, 64};
  static constexpr GridPoint kCorner{432'000.0, 4'182'016.0};
  testing::TemporaryFolder folder;
};

TEST_F(ElevationModels, GiveTheMeanHeightsOfCellsWhetherTheyAreFinerOrCoarser) {
  for (const double pixel_m : {5.0, 10.0, 30.0, 32.0, 90.0, 300.0}) {
    const int side = static_cast<int>(std::ceil(3000.0 / pixel_m));
    const RasterSpec around = spec({kCorner.east_m - 411.0, kCorner.north_m + 333.0}, pixel_m, side, side);
    EXPECT_LT(error_m(read({write("a.tif", around, slope(around))}).terrain), pixel_m < 100.0 ? 0.2 : 0.5) << pixel_m;
  }
}

TEST_F(ElevationModels, AverageWhatIsFinerThanACell) {
  const RasterSpec fine = spec(kCorner, 4.0, 512, 512);
  const auto stripes = write("a.tif", fine, [](int, int col, int) { return col % 8 < 4 ? 100.0 : 200.0; });
  const Terrain terrain = read({stripes}).terrain;
  EXPECT_NEAR(terrain.cell_height_m(30, 30).value(), 150.0, 0.11);
}

TEST_F(ElevationModels, AreReadInAnyReferenceSystem) {
  RasterSpec degrees = spec({}, 1.0, 150, 150);
  degrees.epsg = 4326;
  degrees.transform = std::array{38.22, 1.0 / 3600.0, 0.0, 37.79, 0.0, -1.0 / 3600.0};
  const auto height = [](int, int col, int row) {
    const LatLon place{37.79 - (row + 0.5) / 3600.0, 38.22 + (col + 0.5) / 3600.0};
    return slope_m(kZone37.project(place));
  };
  EXPECT_LT(error_m(read({write("a.tif", degrees, height)}).terrain), 0.3);
}

TEST_F(ElevationModels, AWholeWorldInOneFileIsReadToo) {
  RasterSpec world = spec({}, 1.0, 360, 180);
  world.epsg = 4326;
  world.type = GDT_Int16;
  world.transform = std::array{-180.0, 1.0, 0.0, 90.0, 0.0, -1.0};
  const Terrain terrain = read({write("a.tif", world, [](int, int, int) { return 812.0; })}).terrain;
  EXPECT_NEAR(terrain.cell_height_m(10, 10).value(), 812.0, 0.1);
}

TEST_F(ElevationModels, KnowNothingWhereTheyAreMarkedOrEnd) {
  RasterSpec half = spec(kCorner, 32.0, 32, 64);
  half.nodata = -32768.0;
  half.type = GDT_Int16;
  const auto hole = write("a.tif", half, [](int, int col, int row) { return col == 5 && row == 7 ? -32768.0 : 300.0; });
  const Terrain terrain = read({hole}).terrain;
  EXPECT_NEAR(terrain.cell_height_m(4, 7).value(), 300.0, 0.1);
  EXPECT_FALSE(terrain.cell_height_m(5, 7));
  EXPECT_NEAR(terrain.cell_height_m(31, 63).value(), 300.0, 0.1);
  EXPECT_FALSE(terrain.cell_height_m(32, 63));
}

TEST_F(ElevationModels, KnowNothingInTheGapsOfAMosaic) {
  const RasterSpec west = spec(kCorner, 32.0, 20, 64);
  const RasterSpec east = spec({kCorner.east_m + 1280.0, kCorner.north_m}, 32.0, 24, 64);
  const std::string a = write("a.tif", west, slope(west));
  const std::string b = write("b.tif", east, slope(east));
  const std::string vrt = folder / "ab.vrt";
  std::ofstream(vrt) << R"(<VRTDataset rasterXSize="64" rasterYSize="64"><SRS>EPSG:32637</SRS>)"
                     << "<GeoTransform>432000, 32, 0, 4182016, 0, -32</GeoTransform>"
                     << R"(<VRTRasterBand dataType="Float32" band="1">)"
                     << "<SimpleSource><SourceFilename>" << a << "</SourceFilename><SourceBand>1</SourceBand>"
                     << R"(<SrcRect xOff="0" yOff="0" xSize="20" ySize="64"/>)"
                     << R"(<DstRect xOff="0" yOff="0" xSize="20" ySize="64"/></SimpleSource>)"
                     << "<SimpleSource><SourceFilename>" << b << "</SourceFilename><SourceBand>1</SourceBand>"
                     << R"(<SrcRect xOff="0" yOff="0" xSize="24" ySize="64"/>)"
                     << R"(<DstRect xOff="40" yOff="0" xSize="24" ySize="64"/></SimpleSource>)"
                     << "</VRTRasterBand></VRTDataset>";
  const Terrain terrain = read({vrt}).terrain;
  EXPECT_NEAR(terrain.cell_height_m(10, 10).value(), slope_m(kCells.cell_center(10, 10)), 0.2);
  EXPECT_FALSE(terrain.cell_height_m(30, 10));
  EXPECT_NEAR(terrain.cell_height_m(50, 10).value(), slope_m(kCells.cell_center(50, 10)), 0.2);
}

TEST_F(ElevationModels, TheFinerCountsWhereBothKnow) {
  const RasterSpec coarse = spec({kCorner.east_m - 300.0, kCorner.north_m + 300.0}, 90.0, 40, 40);
  const RasterSpec fine = spec(kCorner, 16.0, 64, 128);
  const auto a = write("a.tif", coarse, [](int, int, int) { return 100.0; });
  const auto b = write("b.tif", fine, [](int, int, int) { return 200.0; });
  for (const auto& paths : {std::vector{a, b}, std::vector{b, a}}) {
    const ElevationReading reading = read(paths);
    EXPECT_NEAR(reading.terrain.cell_height_m(30, 10).value(), 200.0, 0.1);
    EXPECT_NEAR(reading.terrain.cell_height_m(33, 10).value(), 100.0, 0.1);
    EXPECT_THAT(reading.beside, IsEmpty());
  }
}

TEST_F(ElevationModels, JoinWithoutSeamsWhereTheyMeet) {
  std::vector<std::string> quarters;
  for (const double east_m : {kCorner.east_m - 100.0, kCorner.east_m + 1040.0}) {
    for (const double north_m : {kCorner.north_m + 100.0, kCorner.north_m - 1040.0}) {
      const RasterSpec part = spec({east_m, north_m}, 30.0, 38, 38);
      quarters.push_back(write("part" + std::to_string(quarters.size()) + ".tif", part, slope(part)));
    }
  }
  const GridGeometry within{32.0, kCells.origin, 62, 62};
  EXPECT_LT(error_m(read(quarters, within).terrain), 1.0);
}

TEST_F(ElevationModels, TellsWhichModelsLieBeside) {
  const RasterSpec there = spec(kCorner, 32.0, 64, 64);
  const RasterSpec elsewhere = spec({500'000.0, 4'300'000.0}, 32.0, 64, 64);
  const auto a = write("a.tif", there, slope(there));
  const auto b = write("b.tif", elsewhere, slope(elsewhere));
  EXPECT_THAT(read({a, b}).beside, ElementsAre(b));
  EXPECT_EQ(code_of([&] { read({b}); }), "elevation-beyond-map");
  EXPECT_THAT(message_of([&] { read({b}); }), HasSubstr("latitude 37.7"));
}

TEST_F(ElevationModels, RespectScaleOffsetAndUnit) {
  const RasterSpec plain = spec(kCorner, 32.0, 64, 64);
  const auto height = [&](const char* unit, double scale, double offset) {
    const std::string path = write("a.tif", plain, [](int, int, int) { return 1000.0; });
    {
      const DatasetPtr data(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
      data->GetRasterBand(1)->SetUnitType(unit);
      data->GetRasterBand(1)->SetScale(scale);
      data->GetRasterBand(1)->SetOffset(offset);
    }
    return read({path}).terrain.cell_height_m(20, 20).value();
  };
  EXPECT_NEAR(height("", 1.0, 0.0), 1000.0, 0.1);
  EXPECT_NEAR(height("metre", 1.0, 0.0), 1000.0, 0.1);
  EXPECT_NEAR(height("unspecified", 1.0, 0.0), 1000.0, 0.1);
  EXPECT_NEAR(height("ft", 1.0, 0.0), 304.8, 0.1);
  for (const char* foot : {"US survey foot", "us-ft", "Foot_US"}) EXPECT_NEAR(height(foot, 1.0, 0.0), 304.8, 0.1);
  EXPECT_EQ(code_of([&] { height("dm", 1.0, 0.0); }), "elevation-unit-unknown");
  EXPECT_NEAR(height("m", 0.1, 50.0), 150.0, 0.1);
  EXPECT_NEAR(height("ft", 0.1, 50.0), 150.0 * 0.3048, 0.1);
}

TEST_F(ElevationModels, OfAVerticalReferenceSystemInFeetAreInFeet) {
  RasterSpec feet = spec(kCorner, 32.0, 64, 64);
  feet.epsg = 0;
  const std::string path = write("a.tif", feet, [](int, int, int) { return 1000.0; });
  {
    const DatasetPtr data(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    const OGRSpatialReference reference = parse_crs("EPSG:32637+6360");
    data->SetSpatialRef(&reference);
  }
  EXPECT_NEAR(read({path}).terrain.cell_height_m(20, 20).value(), 304.8, 0.1);
}

TEST_F(ElevationModels, BesideCoordinatesInFeetHaveToSayWhetherTheyAreInFeet) {
  RasterSpec feet = spec(kCorner, 32.0, 64, 64);
  feet.epsg = 0;
  constexpr double kFootM = 1200.0 / 3937.0;
  feet.transform =
      std::array{kCorner.east_m / kFootM, 32.0 / kFootM, 0.0, kCorner.north_m / kFootM, 0.0, -32.0 / kFootM};
  const std::string path = write("a.tif", feet, [](int, int, int) { return 1000.0; });
  const auto height = [&](const char* unit) {
    {
      const DatasetPtr data(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
      const OGRSpatialReference reference = parse_crs("+proj=utm +zone=37 +datum=WGS84 +units=us-ft");
      data->SetSpatialRef(&reference);
      data->GetRasterBand(1)->SetUnitType(unit);
    }
    return read({path}).terrain.cell_height_m(20, 20).value();
  };
  EXPECT_THAT(message_of([&] { height(""); }), HasSubstr("counts in 'US survey foot', and nothing tells whether"));
  EXPECT_NEAR(height("ft"), 304.8, 0.1);
  EXPECT_NEAR(height("m"), 1000.0, 0.1);
}

TEST_F(ElevationModels, AboveTheEllipsoidAreRefusedAndAboveAGeoidAreNot) {
  const std::string zone =
      R"(PROJCS["WGS 84 / UTM zone 37N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,)"
      R"(298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],)"
      R"(PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
      R"(PARAMETER["central_meridian",39],PARAMETER["scale_factor",0.9996],)"
      R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]])";
  const RasterSpec plain = spec(kCorner, 32.0, 64, 64);
  const auto reading = [&](const std::string& crs) {
    const std::string path = write("a.tif", plain, [](int, int, int) { return 700.0; });
    const std::string vrt = folder / "a.vrt";
    std::ofstream(vrt) << R"(<VRTDataset rasterXSize="64" rasterYSize="64"><SRS>)" << crs
                       << "</SRS><GeoTransform>432000, 32, 0, 4182016, 0, -32</GeoTransform>"
                       << R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename>)" << path
                       << "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    return read({vrt});
  };
  for (const std::string& crs :
       {"COMPD_CS[\"3D\"," + zone + R"(,VERT_CS["height",VERT_DATUM["Ellipsoid",2002],UNIT["metre",1],AXIS["Up",UP]]])",
        "COMPD_CS[\"3D\"," + zone +
            R"(,VERT_CS["WGS 84 ellipsoid",VERT_DATUM["WGS 84 ellipsoid",2005],UNIT["metre",1],AXIS["Up",UP]]])"}) {
    EXPECT_EQ(code_of([&] { reading(crs); }), "elevation-above-ellipsoid") << crs;
    EXPECT_THAT(message_of([&] { reading(crs); }), HasSubstr("gdalwarp"));
  }
  for (const std::string crs : {"EPSG:32637", "EPSG:32637+5773", "EPSG:32637+3855"}) {
    EXPECT_NEAR(reading(crs).terrain.cell_height_m(20, 20).value(), 700.0, 0.1) << crs;
  }
}

TEST_F(ElevationModels, InDegreesAndHeightsAboveTheEllipsoidAreRefused) {
  RasterSpec degrees = spec({}, 1.0, 150, 150);
  degrees.epsg = 4979;
  degrees.transform = std::array{38.22, 1.0 / 3600.0, 0.0, 37.79, 0.0, -1.0 / 3600.0};
  const std::string path = write("a.tif", degrees, [](int, int, int) { return 700.0; });
  EXPECT_EQ(code_of([&] { read({path}); }), "elevation-above-ellipsoid");
}

TEST_F(ElevationModels, PicturesAreRefused) {
  RasterSpec colours = spec(kCorner, 32.0, 64, 64);
  colours.type = GDT_Byte;
  RasterSpec grey = colours;
  colours.bands = 3;
  RasterSpec bands = spec(kCorner, 32.0, 64, 64);
  bands.bands = 4;
  for (const RasterSpec& picture : {colours, grey, bands}) {
    const auto path = write("a.tif", picture, [](int, int, int) { return 90.0; });
    EXPECT_EQ(code_of([&] { read({path}); }), "elevation-not-heights");
  }
}

TEST_F(ElevationModels, WithHeightsThatNoGroundHasAreRefused) {
  const RasterSpec plain = spec(kCorner, 32.0, 64, 64);
  for (const double wrong_m : {-9999.0, 20'000.0, 3.4e38}) {
    const auto path =
        write("a.tif", plain, [&](int, int col, int row) { return col == 5 && row == 7 ? wrong_m : 300.0; });
    EXPECT_EQ(code_of([&] { read({path}); }), "elevation-impossible") << wrong_m;
    EXPECT_THAT(message_of([&] { read({path}); }), HasSubstr("-a_nodata"));
  }
}

TEST_F(ElevationModels, StopWhenAsked) {
  const RasterSpec plain = spec(kCorner, 32.0, 64, 64);
  const auto path = write("a.tif", plain, slope(plain));
  std::vector<std::int64_t> steps;
  read_elevation_models({path}, kZone37, {32.0, kCells.origin, 300, 64}, [&](std::int64_t done, std::int64_t total) {
    steps.push_back(done);
    EXPECT_EQ(total, 2);
  });
  EXPECT_THAT(steps, ElementsAre(1, 2));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(code_of([&] { read_elevation_models({path}, kZone37, kCells, {}, stop.get_token()); }), "work-stopped");
}

TEST(TerrainGeometry, IsTheGroundAndTwoKilometresAroundItInTheFinestCellsThatAreFewEnough) {
  const GridBox ground{{432'000.0, 4'180'000.0}, {442'000.0, 4'185'000.0}};
  const GridGeometry finest = terrain_geometry(ground, 1 << 24);
  EXPECT_EQ(finest.cell_m, 32.0);
  EXPECT_EQ(finest, GridGeometry::covering(grown(ground, 2000.0), 32.0));
  EXPECT_EQ(terrain_geometry(ground, std::int64_t{finest.cols} * finest.rows).cell_m, 32.0);
  EXPECT_EQ(terrain_geometry(ground, std::int64_t{finest.cols} * finest.rows - 1).cell_m, 64.0);
  EXPECT_EQ(terrain_geometry(ground, 4000).cell_m, 256.0);
}

TEST(TerrainGeometry, EndsWithTheLattice) {
  const GridGeometry corner = terrain_geometry({{1000.0, 500.0}, {3000.0, 2000.0}}, 1 << 24);
  EXPECT_EQ(corner.box().min, (GridPoint{0.0, 0.0}));
}

}  // namespace
}  // namespace roadfix
