#include "tiles/imagery/mosaic.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <barrier>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/place.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/imagery/collar.hpp"

namespace roadfix {
namespace {

using testing::around;
using testing::kCentre;
using testing::kZone;
using testing::RasterSpec;
using testing::write_raster;

class MosaicTest : public ::testing::Test {
 protected:
  /// What is added to a value so that no ground is blank: 0 or kTexture, in squares of 4 pixels.
  static constexpr double kTexture = 6.0;
  static double texture(int col, int row) { return (col / 4 + row / 4) % 2 == 0 ? 0.0 : kTexture; }
  /// Of the view's pixels, those of a square of that value.
  static cv::Mat of_value(const GroundImage& view, double value) {
    return (view.pixels >= value) & (view.pixels <= value + kTexture);
  }
  /// A square of `side` pixels of 1 m whose south-western corner lies `east`, `north` of the centre.
  std::string square(const std::string& name, double east, double north, int side, double value,
                     double nodata_cols = 0) {
    RasterSpec spec{.width = side, .height = side, .nodata = 9.0};
    spec.transform = {kCentre.east_m + east, 1.0, 0.0, kCentre.north_m + north + side, 0.0, -1.0};
    return write_raster(folder / name, spec,
                        [&](int, int col, int row) { return col < nodata_cols ? 9.0 : value + texture(col, row); });
  }
  static GridBox box(double east, double north, double side) {
    return {{kCentre.east_m + east, kCentre.north_m + north},
            {kCentre.east_m + east + side, kCentre.north_m + north + side}};
  }
  testing::TemporaryFolder folder;
};

TEST_F(MosaicTest, WhatAnImageShowsBlankDoesNotDependOnOthersElsewhereInTheView) {
  // A roof beside a yard of another colour that is too narrow to be blank, but would be where the roof was not seen.
  RasterSpec spec{.width = 64, .height = 64};
  spec.transform = {kCentre.east_m, 1.0, 0.0, kCentre.north_m + 64, 0.0, -1.0};
  const std::string roof = write_raster(folder / "roof.tif", spec, [](int, int col, int row) {
    return col < 24 ? 200.0 : col < 36 ? 90.0 : 120.0 + texture(col, row);
  });
  const auto seen = [&](const std::vector<std::string>& paths) {
    const Mosaic mosaic(paths, {}, ValueRule::kPicture, kZone);
    return mosaic.view(box(0, 0, 512), 1.0).observed(cv::Rect(0, 448, 64, 64)).clone();
  };
  const cv::Mat alone = seen({roof});
  EXPECT_EQ(cv::countNonZero(alone.colRange(28, 64)), 36 * 64);
  EXPECT_EQ(cv::countNonZero(alone != seen({roof, square("far.tif", 256, 256, 64, 100)})), 0);
}

TEST_F(MosaicTest, TheFirstImageThatHoldsSomethingWins) {
  const Mosaic mosaic({square("a.tif", 0, 0, 64, 100, 16), square("b.tif", 0, 0, 64, 200)}, {}, ValueRule::kPicture,
                      kZone);
  const GroundImage view = mosaic.view(box(0, 0, 64), 1.0);
  EXPECT_EQ(cv::countNonZero(view.observed), 64 * 64);
  EXPECT_EQ(cv::countNonZero(of_value(view, 200)), 16 * 64);
  EXPECT_EQ(cv::countNonZero(of_value(view, 100)), 48 * 64);
}

TEST_F(MosaicTest, GroundBesideTheImagesIsNotObserved) {
  const Mosaic mosaic({square("a.tif", 0, 0, 64, 100)}, {}, ValueRule::kPicture, kZone);
  const GroundImage view = mosaic.view(box(-32, -32, 128), 1.0);
  EXPECT_EQ(cv::countNonZero(view.observed), 64 * 64);
  EXPECT_EQ(view.observed.at<std::uint8_t>(32, 31), 0);
  EXPECT_EQ(view.observed.at<std::uint8_t>(32, 32), 255);
  EXPECT_TRUE(mosaic.touches(box(63, 63, 10)));
  EXPECT_FALSE(mosaic.touches(box(65, 65, 10)));
}

TEST_F(MosaicTest, NodataDoesNotBleedIntoItsNeighbours) {
  const Mosaic mosaic({square("a.tif", 0, 0, 64, 100, 21)}, {}, ValueRule::kPicture, kZone);
  for (const double gsd : {0.5, 1.0, 2.0, 4.0}) {
    const GroundImage view = mosaic.view(box(0, 0, 64), gsd);
    cv::Mat right;
    cv::inRange(view.pixels, 99, 101 + kTexture, right);  // averages are rounded
    const cv::Mat wrong = ~right & (view.observed != 0);
    EXPECT_EQ(cv::countNonZero(wrong), 0) << "gsd " << gsd;
    EXPECT_NEAR(cv::countNonZero(view.observed) * gsd * gsd, 43.0 * 64.0, gsd * 64.0) << "gsd " << gsd;
  }
}

TEST_F(MosaicTest, FinePixelsAreAveragedNotPickedOut) {
  RasterSpec spec{.width = 512, .height = 512};
  spec.transform = {kCentre.east_m, 0.25, 0.0, kCentre.north_m + 128, 0.0, -0.25};
  const std::string path =
      write_raster(folder / "a.tif", spec, [](int, int col, int row) { return (col + row) % 2 * 200.0; });
  const Mosaic mosaic({path}, {}, ValueRule::kPicture, kZone);
  const GroundImage view = mosaic.view(box(8, 8, 64), 2.0);
  double low = 0.0;
  double high = 0.0;
  cv::minMaxLoc(view.pixels, &low, &high);
  EXPECT_NEAR(low, 100.0, 1.0);
  EXPECT_NEAR(high, 100.0, 1.0);
}

TEST_F(MosaicTest, AViewDoesNotDependOnHowTheGroundIsCutIntoViews) {
  RasterSpec spec{.width = 700, .height = 700, .bands = 3};
  spec.transform = around(kCentre.east_m, kCentre.north_m, 0.4, 0.4, 20.0);
  const std::string path = write_raster(
      folder / "a.tif", spec, [](int band, int col, int row) { return (col * 31 + row * 17 + band * 50) % 256; });
  const Mosaic mosaic({path}, {}, ValueRule::kPicture, kZone);
  const GroundImage whole = mosaic.view(box(-64, -64, 128), 0.5);
  const GroundImage part = mosaic.view(box(-32, -16, 64), 0.5);
  const cv::Rect same(64, 256 - 96 - 128, 128, 128);
  EXPECT_LE(cv::norm(whole.pixels(same), part.pixels, cv::NORM_INF), 12.0);
  EXPECT_EQ(cv::norm(whole.observed(same), part.observed, cv::NORM_INF), 0.0);
}

TEST_F(MosaicTest, SixteenBitImagesOfOneSourceShareOneRange) {
  const auto image = [&](const std::string& name, double east, double low) {
    RasterSpec spec{.type = GDT_UInt16};
    spec.transform = {kCentre.east_m + east, 1.0, 0.0, kCentre.north_m + 64, 0.0, -1.0};
    return write_raster(folder / name, spec, [low](int, int col, int) { return low + 10.0 * col; });
  };
  const Mosaic mosaic({image("a.tif", 0, 1000), image("b.tif", 64, 3000)}, {}, ValueRule::kPicture, kZone);
  EXPECT_NEAR(mosaic.range().low, 1000.0, 20.0);
  EXPECT_NEAR(mosaic.range().high, 3630.0, 20.0);
}

TEST_F(MosaicTest, BytesStayAsTheyAreBesideImagesOfOtherTypes) {
  RasterSpec deep{.type = GDT_UInt16};
  deep.transform = {kCentre.east_m + 64, 1.0, 0.0, kCentre.north_m + 64, 0.0, -1.0};
  const std::string wide =
      write_raster(folder / "wide.tif", deep, [](int, int col, int) { return 1000.0 + 10.0 * col; });
  RasterSpec bit{.creation = {"NBITS=1"}};
  bit.transform = {kCentre.east_m + 128, 1.0, 0.0, kCentre.north_m + 64, 0.0, -1.0};
  const std::string drawn =
      write_raster(folder / "drawn.tif", bit, [](int, int col, int row) { return (col + row) % 2 == 0 ? 1.0 : 0.0; });
  const std::string bytes = square("bytes.tif", 0, 0, 64, 100);
  for (const auto& paths : {std::vector{bytes, wide, drawn}, std::vector{drawn, wide, bytes}}) {
    const Mosaic mosaic(paths, {}, ValueRule::kPicture, kZone);
    cv::Mat grey;
    cv::extractChannel(mosaic.view(box(0, 0, 192), 1.0).pixels, grey, 0);
    const int row = 192 - 32;
    EXPECT_EQ(grey.at<std::uint8_t>(row, 32), 100);
    EXPECT_NEAR(grey.at<std::uint8_t>(row, 96), 128, 4);
    EXPECT_EQ(grey.at<std::uint8_t>(row, 160), 255);
  }
}

TEST_F(MosaicTest, ADeclaredCollarIsNotObservedButAWhiteRoofIs) {
  RasterSpec spec{.width = 200, .height = 200, .bands = 3};
  spec.transform = {kCentre.east_m, 1.0, 0.0, kCentre.north_m + 200, 0.0, -1.0};
  const auto inside = [](int col, int row) { return col + row > 100 && col < 190; };
  const auto roof = [](int col, int row) { return col >= 120 && col < 132 && row >= 120 && row < 132; };
  const std::string path = write_raster(folder / "a.tif", spec, [&](int, int col, int row) {
    return roof(col, row) ? 255.0 : (inside(col, row) ? 90.0 + texture(col, row) : 252.0 + (col % 4));
  });
  const Mosaic mosaic({path}, {.crs = "", .collar = Rgb{255, 255, 255}}, ValueRule::kPicture, kZone);
  const GroundImage view = mosaic.view(box(0, 0, 200), 1.0);
  for (int row = 0; row < 200; ++row) {
    for (int col = 0; col < 200; ++col) {
      ASSERT_EQ(view.observed.at<std::uint8_t>(row, col) != 0, inside(col, row)) << col << ' ' << row;
    }
  }
}

TEST_F(MosaicTest, APaintedCollarHidesNoOtherImageAndIsNotObserved) {
  RasterSpec spec{.width = 200, .height = 200};
  spec.transform = {kCentre.east_m, 1.0, 0.0, kCentre.north_m + 200, 0.0, -1.0};
  const std::string path = write_raster(
      folder / "a.tif", spec, [&](int, int col, int row) { return col < 100 ? 255.0 : 90.0 + texture(col, row); });
  const Mosaic alone({path}, {}, ValueRule::kPicture, kZone);
  const GroundImage seen = alone.view(box(0, 0, 200), 1.0);
  EXPECT_EQ(cv::countNonZero(seen.observed.colRange(0, 100)), 0);
  EXPECT_EQ(cv::countNonZero(seen.observed.colRange(104, 200)), 96 * 200);
  const Mosaic both({path, square("b.tif", 0, 0, 64, 150)}, {}, ValueRule::kPicture, kZone);
  const GroundImage merged = both.view(box(0, 0, 200), 1.0);
  EXPECT_EQ(cv::countNonZero(of_value(merged, 150) & (merged.observed != 0)), 64 * 64);
}

TEST_F(MosaicTest, TheThinWedgesBesideATurnedImageAreNotObserved) {
  RasterSpec spec{.width = 400, .height = 400, .bands = 3};
  spec.transform = {kCentre.east_m, 1.0, 0.0, kCentre.north_m + 400, 0.0, -1.0};
  const auto inside = [](int col, int row) { return 50 * row > 400 - col && 50 * (399 - row) > col; };
  for (const double painted : {0.0, 255.0}) {
    const std::string path = write_raster(folder / "a.tif", spec, [&](int, int col, int row) {
      return inside(col, row) ? 90.0 + texture(col, row) : painted;
    });
    const Mosaic mosaic({path}, {}, ValueRule::kPicture, kZone);
    const GroundImage view = mosaic.view(box(0, 0, 400), 1.0);
    for (int row = 0; row < 400; ++row) {
      for (int col = 0; col < 400; ++col) {
        ASSERT_EQ(view.observed.at<std::uint8_t>(row, col) != 0, inside(col, row)) << painted << col << ' ' << row;
      }
    }
  }
}

TEST_F(MosaicTest, HeightsBesideAnOrthophotoAreRefusedWhicheverComesFirst) {
  RasterSpec colours{.width = 64, .height = 64, .bands = 3};
  RasterSpec heights{.width = 64, .height = 64, .type = GDT_Float32};
  for (RasterSpec* spec : {&colours, &heights}) {
    spec->transform = {kCentre.east_m, 1.0, 0.0, kCentre.north_m + 64, 0.0, -1.0};
  }
  const std::string dsm = write_raster(folder / "dsm.tif", heights, [](int, int col, int) { return 500.0 + col; });
  const std::string ortho = write_raster(folder / "ortho.tif", colours, [](int, int col, int) { return 2.0 * col; });
  const std::string grey = square("grey.tif", 0, 0, 64, 100);
  const auto refusal = [&](const std::vector<std::string>& paths) {
    return testing::code_of([&] { Mosaic(paths, {}, ValueRule::kPicture, kZone); });
  };
  EXPECT_EQ(refusal({dsm, ortho}), "imagery-mixed");
  EXPECT_EQ(refusal({ortho, dsm}), "imagery-mixed");
  EXPECT_EQ(refusal({grey, ortho}), "no error");
}

TEST_F(MosaicTest, ShareOfRoadMayBeTheSameEverywhere) {
  const Mosaic mosaic({square("a.tif", 0, 0, 64, 0)}, {}, ValueRule::kShare, kZone);
  EXPECT_EQ(cv::countNonZero(mosaic.view(box(0, 0, 64), 1.0).observed), 64 * 64);
}

TEST_F(MosaicTest, CoordinatesWithoutAPlaceInTheZoneAreRefused) {
  RasterSpec spec;
  spec.epsg = 4326;
  spec.transform = {500000.0, 1.0, 0.0, 4200064.0, 0.0, -1.0};  // metres given as degrees
  const std::string path = write_raster(folder / "a.tif", spec, [](int, int, int) { return 1.0; });
  try {
    const Mosaic mosaic({path}, {}, ValueRule::kPicture, kZone);
    FAIL() << "extent " << mosaic.extent().min.east_m;
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.code(), "crs-not-transformable");
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--crs of ingest"));
  }
}

TEST_F(MosaicTest, AnOldDatumNeedsAWayToWgs84AroundThere) {
  const RasterSpec damascus{.epsg = 0, .transform = std::array<double, 6>{6797000, 1, 0, 3711000, 0, -1}};
  const std::string path = write_raster(folder / "a.tif", damascus, [](int, int, int) { return 1.0; });
  const auto code_in = [&](const std::string& crs) {
    return testing::code_of([&] { Mosaic({path}, {.crs = crs, .collar = {}}, ValueRule::kPicture, kZone); });
  };
  EXPECT_EQ(code_in("EPSG:28406"), "datum-unknown") << "Pulkovo 1942, to which ways are known elsewhere";
  EXPECT_EQ(code_in("+proj=tmerc +lon_0=33 +x_0=6500000 +ellps=krass +towgs84=28,-130,-95 +no_defs"), "no error");
}

TEST_F(MosaicTest, AnOldEllipsoidNeedsADatumToLieAnywhere) {
  const std::string path = write_raster(folder / "a.tif", {.epsg = 0}, [](int, int, int) { return 1.0; });
  const auto west = [&](const std::string& crs) {
    return Mosaic({path}, {.crs = crs, .collar = {}}, ValueRule::kPicture, kZone).extent().min.east_m;
  };
  EXPECT_EQ(testing::code_of([&] { west("+proj=utm +zone=37 +ellps=intl +no_defs"); }), "datum-unknown");
  EXPECT_EQ(testing::code_of([&] { west("EPSG:2327"); }), "datum-unknown")
      << "Xian 1980, whose ellipsoid is 3 m larger";
  EXPECT_NEAR(west("EPSG:32237"), 400000.0 + 14.0, 2.0) << "WGS 72, whose is 2 m smaller";
  EXPECT_NEAR(west("EPSG:23037"), 400000.0 - 14.0, 5.0) << "ED50 lies 180 m to the south, too";
  EXPECT_NEAR(west("+proj=utm +zone=37 +ellps=intl +towgs84=-87,-98,-121,0,0,0,0 +no_defs"), 400000.0 - 14.0, 12.0);
  for (const char* ellipsoid : {"GRS80", "WGS84"}) {
    EXPECT_NEAR(west(fmt::format("+proj=utm +zone=37 +ellps={} +no_defs", ellipsoid)), 400000.0, 0.1) << ellipsoid;
  }
}

TEST_F(MosaicTest, TheGridOfASiteSaysNothingOfWhereOnEarthAnImageLies) {
  const std::string path = write_raster(folder / "a.tif", {.epsg = 0}, [](int, int, int) { return 1.0; });
  DatasetPtr(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE))
      ->SetProjection(R"(LOCAL_CS["Site grid",UNIT["metre",1]])");
  const auto message = testing::message_of([&] { Mosaic({path}, {}, ValueRule::kPicture, kZone); });
  EXPECT_THAT(message, ::testing::HasSubstr("no reference system of the Earth (it names 'Site grid')"));
  const Mosaic placed({path}, {.crs = "EPSG:32637", .collar = {}}, ValueRule::kPicture, kZone);
  EXPECT_NEAR(placed.extent().min.east_m, 400000.0, 0.1);
}

TEST_F(MosaicTest, ARasterThatGoesOnBeyondTheEndOfItsReferenceSystemIsRefused) {
  constexpr double kAntimeridianM = 20037508.34;
  RasterSpec spec{.width = 200, .height = 100, .epsg = 3857};
  const UtmZone fiji = *UtmZone::from_epsg(32760);
  const auto write = [&](const char* name, double west_m) {
    spec.transform = {west_m, 1.0, 0.0, -1'900'000.0, 0.0, -1.0};
    return write_raster(folder / name, spec, [](int, int col, int row) { return 1.0 + texture(col, row); });
  };
  EXPECT_EQ(
      testing::code_of([&] { Mosaic({write("across.tif", kAntimeridianM - 50)}, {}, ValueRule::kPicture, fiji); }),
      "raster-beyond-its-reference");
  const Mosaic halves({write("west.tif", kAntimeridianM - 200), write("east.tif", -kAntimeridianM)}, {},
                      ValueRule::kPicture, fiji);
  EXPECT_GT(halves.extent().width_m(), 370.0) << "400 m of the projection, which are fewer on the ground";
  const GroundImage seen = halves.view(halves.extent(), 1.0);
  EXPECT_GT(cv::countNonZero(seen.observed), 0.8 * static_cast<double>(seen.observed.total()));
}

TEST_F(MosaicTest, RasterOfDegreesMayCrossTheAntimeridian) {
  RasterSpec spec{.width = 200, .height = 100, .epsg = 4326};
  for (const double west : {179.999, -180.001}) {
    spec.transform = {west, 1e-5, 0.0, -16.9, 0.0, -1e-5};
    const std::string path = write_raster(folder / "a.tif", spec, [](int, int, int) { return 1.0; });
    const Mosaic mosaic({path}, {}, ValueRule::kPicture, *UtmZone::from_epsg(32701));
    EXPECT_NEAR(mosaic.extent().width_m(), 215.0, 5.0);
  }
}

TEST_F(MosaicTest, MosaicsOfMoreColumnsThanFitIntoTheirProductsLieWhereTheySay) {
  std::ofstream(folder / "wide.vrt") << R"(<VRTDataset rasterXSize="80000000" rasterYSize="8"><SRS>EPSG:32637</SRS>
    <GeoTransform>400000, 0.001, 0, 4200000, 0, -0.001</GeoTransform><VRTRasterBand dataType="Byte" band="1"/></VRTDataset>)";
  const Mosaic mosaic({(folder / "wide.vrt").string()}, {}, ValueRule::kPicture, kZone);
  EXPECT_NEAR(mosaic.extent().min.east_m, 400'000.0, 0.1);
  EXPECT_NEAR(mosaic.extent().width_m(), 80'000.0, 0.1);
}

TEST_F(MosaicTest, SharesOfRoadOfSeveralTypesAreRefused) {
  const std::string bytes = write_raster(folder / "bytes.tif", {}, [](int, int, int) { return 255.0; });
  const std::string shares =
      write_raster(folder / "shares.tif", {.type = GDT_Float32}, [](int, int, int) { return 1.0; });
  const std::string wide =
      write_raster(folder / "wide.tif", {.type = GDT_UInt16}, [](int, int, int) { return 65535.0; });
  for (const auto& paths : {std::vector{bytes, shares}, std::vector{shares, bytes}, std::vector{bytes, wide}}) {
    EXPECT_EQ(testing::code_of([&] { Mosaic(paths, {}, ValueRule::kShare, kZone); }), "road-values-mixed");
  }
}

TEST_F(MosaicTest, ThreadsShareOneFileOfAnImageThatIsUnpackedFromTheTop) {
  const std::string path = (folder / "a.jpg").string();
  {
    const DatasetPtr tile(GDALDataset::Open(square("a.tif", 0, 0, 512, 100).c_str(), GDAL_OF_RASTER));
    const DatasetPtr made(GetGDALDriverManager()->GetDriverByName("JPEG")->CreateCopy(path.c_str(), tile.get(), FALSE,
                                                                                      nullptr, nullptr, nullptr));
  }
  const Mosaic mosaic({path}, {}, ValueRule::kPicture, kZone);
  const auto opened = [&] {
    return std::ranges::count_if(std::filesystem::directory_iterator("/proc/self/fd"), [&](const auto& descriptor) {
      std::error_code gone;
      return std::filesystem::read_symlink(descriptor, gone) == path;
    });
  };
  mosaic.view(box(0, 0, 128), 1.0);
  const auto by_one_thread = opened();
  EXPECT_GT(by_one_thread, 0);
  std::barrier start(4);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      start.arrive_and_wait();
      for (int row = 0; row < 4; ++row) {
        const GroundImage view = mosaic.view(box(128 * i, 128 * row, 128), 1.0);
        EXPECT_EQ(cv::countNonZero(view.observed), 128 * 128);
      }
    });
  }
  threads.clear();
  EXPECT_EQ(opened(), by_one_thread);
}

}  // namespace
}  // namespace roadfix
