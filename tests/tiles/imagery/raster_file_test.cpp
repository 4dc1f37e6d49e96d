#include "tiles/imagery/raster_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/test_raster.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::mosaic_of;
using testing::RasterSpec;
using testing::write_raster;

class RasterFileTest : public ::testing::Test {
 protected:
  RasterPixels read(const RasterSpec& spec, const testing::PixelFunction& value,
                    const std::function<bool(int, int)>& mask = {}, ValueRange range = {}) {
    RasterFile file(write_raster(folder / "a.tif", spec, value, mask), {});
    return file.read({{0, 0}, file.size()}, range);
  }
  testing::TemporaryFolder folder;
};

double band_number(int band, int, int) { return 10.0 * band; }

TEST_F(RasterFileTest, ThreeBandsAreRedGreenBlueInTheirOrder) {
  const RasterPixels pixels = read({.bands = 3}, band_number);
  EXPECT_EQ(pixels.values.at<cv::Vec3b>(5, 5), cv::Vec3b(30, 20, 10));
  EXPECT_EQ(cv::countNonZero(pixels.valid), 64 * 64);
}

TEST_F(RasterFileTest, ColourMeaningsOfTheBandsWinOverTheirOrder) {
  const RasterSpec spec{.bands = 3, .meanings = {GCI_BlueBand, GCI_GreenBand, GCI_RedBand}, .creation = {}};
  EXPECT_EQ(read(spec, band_number).values.at<cv::Vec3b>(5, 5), cv::Vec3b(10, 20, 30));
}

TEST_F(RasterFileTest, DescriptionsOfBandsAreColoursWhereTheirMeaningsAreNot) {
  const auto seen = [&](const std::vector<GDALColorInterp>& meanings, const std::vector<const char*>& names) {
    const std::string path = write_raster(folder / "a.tif", {.bands = 4, .meanings = meanings}, band_number);
    {
      const DatasetPtr file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
      for (std::size_t i = 0; i < names.size(); ++i) {
        file->GetRasterBand(static_cast<int>(i) + 1)->SetDescription(names[i]);
      }
    }
    RasterFile file(path, {});
    return file.read({0, 0, 1, 1}, {}).values.at<cv::Vec3b>(0, 0);
  };
  constexpr GDALColorInterp kNone = GCI_Undefined;
  const std::vector unsaid{GCI_GrayIndex, kNone, kNone, kNone};
  EXPECT_EQ(seen(unsaid, {"Blue", "Green", "Red", "NIR"}), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(seen(unsaid, {"nir", "red", "green", "blue"}), cv::Vec3b(40, 30, 20));
  EXPECT_EQ(seen(unsaid, {"Blue", "Green", "Band 3", "NIR"}), cv::Vec3b(30, 20, 10)) << "not all of them";
  EXPECT_EQ(seen({GCI_RedBand, GCI_GreenBand, GCI_BlueBand, kNone}, {"Blue", "Green", "Red", "NIR"}),
            cv::Vec3b(30, 20, 10))
      << "what programs show";
}

TEST_F(RasterFileTest, AFourthBandThatIsNoAlphaIsLeftAside) {
  const RasterSpec spec{.bands = 4, .meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_Undefined}};
  const RasterPixels pixels = read(spec, [](int band, int, int) { return band == 4 ? 0.0 : 10.0 * band; });
  EXPECT_EQ(pixels.values.at<cv::Vec3b>(5, 5), cv::Vec3b(30, 20, 10));
  EXPECT_EQ(cv::countNonZero(pixels.valid), 64 * 64);
}

TEST_F(RasterFileTest, AlphaBelowHalfMeansThatNothingIsThere) {
  for (const int bands : {2, 4}) {
    RasterSpec spec{.bands = bands, .meanings = {GCI_GrayIndex, GCI_AlphaBand}};
    if (bands == 4) spec.meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
    const RasterPixels pixels = read(spec, [bands](int band, int col, int) {
      return band < bands ? 77.0 : (col < 10 ? 0.0 : (col < 20 ? 127.0 : 200.0));
    });
    EXPECT_EQ(pixels.values.channels(), bands - 1);
    EXPECT_EQ(cv::countNonZero(pixels.valid), 44 * 64);
  }
}

TEST_F(RasterFileTest, AlphaOfSixteenBitsIsAsOpaqueAsItsLargestValueSays) {
  for (const GDALDataType type : {GDT_UInt16, GDT_Int16, GDT_Float32}) {
    const RasterSpec spec{.bands = 2, .type = type, .meanings = {GCI_GrayIndex, GCI_AlphaBand}};
    for (const double opaque : {1.0, 255.0, type == GDT_UInt16 ? 65535.0 : 32767.0}) {
      const RasterPixels pixels =
          read(spec, [=](int band, int col, int) { return band == 1 ? 77.0 : (col < 16 ? 0.0 : opaque); });
      EXPECT_EQ(cv::countNonZero(pixels.valid), 48 * 64) << GDALGetDataTypeName(type) << ' ' << opaque;
    }
  }
  const RasterSpec spec{.bands = 2, .type = GDT_UInt16, .meanings = {GCI_GrayIndex, GCI_AlphaBand}};
  const RasterPixels graded = read(spec, [](int, int col, int) { return 10000.0 * std::min(col, 6); });
  EXPECT_EQ(cv::countNonZero(graded.valid), (64 - 4) * 64) << "half of 65535 lies at column 3.3";
  const RasterPixels clear = read(spec, [](int band, int, int) { return band == 1 ? 77.0 : 0.0; });
  EXPECT_EQ(cv::countNonZero(clear.valid), 0);
}

TEST_F(RasterFileTest, NearInfraredThatIsMarkedAsAlphaHidesNothingButItsZeros) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16, GDT_Float32}) {
    const RasterSpec spec{
        .bands = 4, .type = type, .meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand}};
    const double scale = type == GDT_Byte ? 1.0 : (type == GDT_UInt16 ? 15.0 : 1.0 / 255.0);
    const RasterPixels pixels = read(spec, [=](int band, int col, int row) {
      return band < 4 ? 77.0 * scale : (col < 16 ? 0.0 : (20 + (7 * col + 3 * row) % 200) * scale);
    });
    EXPECT_EQ(cv::countNonZero(pixels.valid), 48 * 64) << GDALGetDataTypeName(type);
  }
  const RasterSpec spec{.bands = 2, .meanings = {GCI_GrayIndex, GCI_AlphaBand}};
  const RasterPixels rim = read(spec, [](int, int col, int) { return std::min(255, 16 * col); });
  EXPECT_EQ(cv::countNonZero(rim.valid), (64 - 8) * 64)
      << "a rim that fades out is none: it is half opaque at column 8";
}

TEST_F(RasterFileTest, AMaskBandMeansThatNothingIsThere) {
  const RasterPixels pixels = read({.bands = 3}, band_number, [](int col, int) { return col >= 16; });
  EXPECT_EQ(cv::countNonZero(pixels.valid), 48 * 64);
  EXPECT_EQ(pixels.valid.at<std::uint8_t>(0, 15), 0);
}

TEST_F(RasterFileTest, WhatAMaskHidesIsNotUnpacked) {
  const RasterSpec spec{.width = 128, .creation = {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "COMPRESS=DEFLATE"}};
  const std::string path = write_raster(
      folder / "a.tif", spec, [](int, int col, int row) { return (7 * col + row) % 200; },
      [](int col, int) { return col >= 64; });
  {
    const long first_block =
        std::stol(open_dataset(path, GDAL_OF_RASTER)->GetRasterBand(1)->GetMetadataItem("BLOCK_OFFSET_0_0", "TIFF"));
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(first_block);
    file << std::string(16, '\xff');
  }
  RasterFile file(path, {});
  EXPECT_EQ(cv::countNonZero(file.read({0, 0, 64, 64}, {}).valid), 0);
  EXPECT_EQ(file.read({64, 0, 64, 64}, {}).values.at<std::uint8_t>(3, 2), (7 * 66 + 3) % 200);
  EXPECT_EQ(code_of([&] { file.read({32, 0, 64, 64}, {}); }), "image-unreadable-block");
}

TEST_F(RasterFileTest, APixelHoldsNothingOnlyWhereEveryBandHasTheNodataValue) {
  const RasterSpec spec{.bands = 3, .nodata = 0.0};
  const RasterPixels pixels = read(spec, [](int band, int col, int) { return col < 8 || band == 1 ? 0.0 : 90.0; });
  EXPECT_EQ(cv::countNonZero(pixels.valid), 56 * 64);
}

TEST_F(RasterFileTest, ANodataValueThatTheTypeCannotHoldMarksNothing) {
  const RasterPixels pixels = read({.nodata = -9999.0}, [](int, int, int) { return 241.0; });
  EXPECT_EQ(cv::countNonZero(pixels.valid), 64 * 64);
}

TEST_F(RasterFileTest, PalettesBecomeColourAndTheirClearEntriesNothing) {
  RasterSpec spec;
  spec.palette = {{1, 2, 3, 255}, {200, 100, 50, 255}};
  spec.nodata = 0.0;
  const RasterPixels pixels = read(spec, [](int, int col, int) { return col < 32 ? 0.0 : 1.0; });
  EXPECT_EQ(pixels.values.at<cv::Vec3b>(3, 40), cv::Vec3b(50, 100, 200));
  EXPECT_EQ(cv::countNonZero(pixels.valid), 32 * 64);
}

TEST_F(RasterFileTest, FloatsThatAreNoNumbersHoldNothing) {
  const auto value = [](int, int col, int) {
    return col == 0 ? std::numeric_limits<double>::quiet_NaN() : (col == 1 ? HUGE_VAL : 0.5);
  };
  const RasterPixels pixels = read({.type = GDT_Float32}, value, {}, {0.0, 1.0});
  EXPECT_EQ(cv::countNonZero(pixels.valid), 62 * 64);
  EXPECT_EQ(pixels.values.at<std::uint8_t>(0, 5), 128);
}

TEST_F(RasterFileTest, SixteenBitsAreStretchedAndClamped) {
  const auto value = [](int, int col, int) { return 1000.0 + 100.0 * col; };
  const RasterPixels pixels = read({.type = GDT_UInt16}, value, {}, {2000.0, 4000.0});
  EXPECT_EQ(pixels.values.at<std::uint8_t>(0, 0), 0);
  EXPECT_NEAR(pixels.values.at<std::uint8_t>(0, 20), 127.5, 0.6);
  EXPECT_EQ(pixels.values.at<std::uint8_t>(0, 60), 255);
}

TEST_F(RasterFileTest, SignedBytesAreReadWithTheirSigns) {
#if GDAL_VERSION_NUM < GDAL_COMPUTE_VERSION(3, 7, 0)
  RasterSpec spec{.bands = 3, .nodata = -1.0, .creation = {"PIXELTYPE=SIGNEDBYTE"}};
  constexpr int kTurn = 256;  // as its bytes are written
#else
  RasterSpec spec{.bands = 3, .type = GDT_Int8, .nodata = -1.0};
  constexpr int kTurn = 0;
#endif
  const auto value = [=](int, int col, int) { return col == 0 ? kTurn - 1 : col == 1 ? kTurn - 100 : col; };
  const RasterPixels pixels = read(spec, value, {}, {-100.0, 155.0});
  EXPECT_EQ(cv::countNonZero(pixels.valid), 63 * 64);
  EXPECT_EQ(pixels.valid.at<std::uint8_t>(5, 0), 0);
  EXPECT_EQ(pixels.values.at<cv::Vec3b>(5, 1), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(pixels.values.at<cv::Vec3b>(5, 50), cv::Vec3b(150, 150, 150));
}

TEST_F(RasterFileTest, OneBitImagesDeclareTheirRange) {
  const RasterFile file(write_raster(folder / "a.tif", {.creation = {"NBITS=1"}}, [](int, int, int) { return 1.0; }),
                        {});
  ASSERT_TRUE(file.declared_range());
  EXPECT_EQ(file.declared_range()->high, 1.0);
}

TEST_F(RasterFileTest, SamplesLeaveOutWhatHoldsNothing) {
  RasterFile file(write_raster(folder / "a.tif", {.width = 300, .height = 200, .type = GDT_UInt16, .nodata = 7.0},
                               [](int, int col, int) { return col < 150 ? 7.0 : 500.0; }),
                  {});
  const std::vector<float> values = file.sample_values();
  EXPECT_GT(values.size(), 1000U);
  EXPECT_THAT(values, ::testing::Each(500.0F));
}

/// As gdaladdo makes them, with -ro beside the file.
void add_overview(const std::string& path, GDALAccess access) {
  int factor = 2;
  const GdalMessages quiet;
  GDALDatasetUniquePtr(GDALDataset::FromHandle(GDALOpen(path.c_str(), access)))
      ->BuildOverviews("NEAREST", 1, &factor, 0, nullptr, nullptr, nullptr);
}

TEST_F(RasterFileTest, OverviewsWithoutTheMaskOfTheirImageAreNotRead) {
  const auto right_half = [](int col, int) { return col >= 150; };
  const RasterSpec spec{.width = 300, .height = 300};
  const std::string with_mask = write_raster(folder / "a.tif", spec, band_number, right_half);
  add_overview(with_mask, GA_Update);
  EXPECT_EQ(RasterFile(with_mask, {}).overview_for(2.0), 0);
  const std::string without = write_raster(folder / "b.tif", spec, band_number, right_half);
  add_overview(without, GA_ReadOnly);
  EXPECT_EQ(RasterFile(without, {}).overview_for(2.0), std::nullopt);
}

TEST_F(RasterFileTest, GapsBetweenTheImagesOfAVrtHoldNothing) {
  const auto image = [&](const char* name, double east_m, double north_m, double pixel_m) {
    const std::array<double, 6> transform{400000.0 + east_m, pixel_m, 0.0, 4200000.0 + north_m, 0.0, -pixel_m};
    return write_raster(folder / name, {.transform = transform}, [](int, int col, int) { return col % 2; });
  };
  const std::string path = mosaic_of(
      folder / "a.vrt", {image("a.tif", 0, 0, 1), image("b.tif", 100, -20, 1), image("c.tif", 164, -84.0, 1)});
  const cv::Size size(228, 148);
  const std::vector<cv::Rect> images{{0, 0, 64, 64}, {100, 20, 64, 64}, {164, 84, 64, 64}};
  const auto holds = [&](double col, double row) {
    return std::ranges::any_of(images, [&](const cv::Rect& part) {
      return col > part.x && col < part.x + part.width && row > part.y && row < part.y + part.height;
    });
  };
  RasterFile file(path, {});
  ASSERT_EQ(file.size(), size);
  for (const cv::Rect& window : {cv::Rect({0, 0}, size), cv::Rect(50, 10, 120, 90), cv::Rect(70, 0, 20, 20)}) {
    const cv::Mat valid = file.read(window, {}).valid;
    for (int row = 0; row < window.height; ++row) {
      for (int col = 0; col < window.width; ++col) {
        ASSERT_EQ(valid.at<std::uint8_t>(row, col) != 0, holds(window.x + col + 0.5, window.y + row + 0.5))
            << window << ' ' << col << ' ' << row;
      }
    }
  }
  add_overview(path, GA_ReadOnly);
  ASSERT_EQ(RasterFile(path, {}).overview_for(2.0), 0);
  RasterFile half(path, {}, 0);
  const cv::Mat valid = half.read({{0, 0}, half.size()}, {}).valid;
  for (int row = 0; row < valid.rows; ++row) {
    for (int col = 0; col < valid.cols; ++col) {
      EXPECT_EQ(valid.at<std::uint8_t>(row, col) != 0, holds(2 * col + 1, 2 * row + 1)) << col << ' ' << row;
    }
  }
}

TEST_F(RasterFileTest, GapsWithinTheVrtsOfAVrtHoldNothing) {
  const auto image = [&](const char* name, double east_m, double pixel_m) {
    const std::array<double, 6> transform{400000.0 + east_m, pixel_m, 0.0, 4200000.0, 0.0, -pixel_m};
    return write_raster(folder / name, {.transform = transform}, [](int, int, int) { return 0.0; });
  };
  const std::string coarse = mosaic_of(folder / "coarse.vrt", {image("a.tif", 0, 2), image("b.tif", 160, 2)});
  const std::string fine = mosaic_of(folder / "fine.vrt", {image("c.tif", 320, 1), image("d.tif", 416, 1)});
  const std::string region = mosaic_of(folder / "region.vrt", {coarse, fine});
  for (const std::string& path : {region, mosaic_of(folder / "country.vrt", {region})}) {
    for (const std::optional<int> overview : {std::optional<int>(), std::optional(0)}) {
      if (overview) add_overview(path, GA_ReadOnly);
      RasterFile file(path, {}, overview);
      const cv::Mat valid = file.read({{0, 0}, file.size()}, {}).valid;
      const int pixel_m = overview ? 2 : 1;
      ASSERT_EQ(file.size(), cv::Size(480 / pixel_m, 128 / pixel_m));
      for (int row = 0; row < valid.rows; ++row) {
        for (int col = 0; col < valid.cols; ++col) {
          const int east = col * pixel_m;
          const bool of_coarse = east < 128 || (east >= 160 && east < 288);
          const bool of_fine = row * pixel_m < 64 && ((east >= 320 && east < 384) || east >= 416);
          ASSERT_EQ(valid.at<std::uint8_t>(row, col) != 0, of_coarse || of_fine) << path << ' ' << col << ' ' << row;
        }
      }
    }
  }
}

TEST_F(RasterFileTest, AVrtThatNamesItselfIsOpened) {
  const std::string path = folder / "a.vrt";
  std::ofstream(path) << R"(<VRTDataset rasterXSize="8" rasterYSize="8"><SRS>EPSG:32637</SRS>
    <GeoTransform>400000, 1, 0, 4200000, 0, -1</GeoTransform><VRTRasterBand dataType="Byte" band="1"><SimpleSource>
    <SourceFilename relativeToVRT="1">a.vrt</SourceFilename><SourceBand>1</SourceBand>
    <SourceProperties RasterXSize="8" RasterYSize="8" DataType="Byte"/>
    <SrcRect xOff="0" yOff="0" xSize="8" ySize="8"/><DstRect xOff="0" yOff="0" xSize="8" ySize="8"/>
    </SimpleSource></VRTRasterBand></VRTDataset>)";
  EXPECT_EQ(RasterFile(path, {}).size(), cv::Size(8, 8));
}

TEST_F(RasterFileTest, AVrtWithoutGapsHoldsAllThatItsImagesHold) {
  const std::string image = write_raster(folder / "a.tif", {.nodata = 10.0}, [](int, int col, int) { return col; });
  RasterFile file(mosaic_of(folder / "a.vrt", {image}), {});
  const cv::Mat valid = file.read({{0, 0}, file.size()}, {}).valid;
  EXPECT_EQ(cv::countNonZero(valid), 64 * 63);
}

TEST_F(RasterFileTest, OverviewsFromBeforeAValueMeantNodataAreNotRead) {
  const std::string path = write_raster(folder / "a.tif", {.width = 300, .height = 300}, band_number);
  add_overview(path, GA_Update);
  EXPECT_EQ(RasterFile(path, {}).overview_for(2.0), 0);
  GDALDatasetUniquePtr(GDALDataset::FromHandle(GDALOpen(path.c_str(), GA_Update)))
      ->GetRasterBand(1)
      ->SetNoDataValue(10.0);
  EXPECT_EQ(RasterFile(path, {}).overview_for(2.0), std::nullopt);
}

TEST_F(RasterFileTest, FilesThatAreNoImagesAreRefusedByName) {
  using namespace std::string_view_literals;
  std::ofstream(folder / "empty.tif") << "";
  std::ofstream(folder / "broken.tif") << "II*\0garbage that is no directory of a TIFF file"sv;
  EXPECT_EQ(code_of([&] { RasterFile((folder / "none.tif").string(), {}); }), "file-not-found");
  EXPECT_EQ(code_of([&] { RasterFile((folder / "empty.tif").string(), {}); }), "source-unreadable");
  EXPECT_EQ(code_of([&] { RasterFile((folder / "broken.tif").string(), {}); }), "source-unreadable");
}

TEST_F(RasterFileTest, AVrtWithoutItsImageSaysThatItIsMissing) {
  const std::string image = write_raster(folder / "a.tif", {}, band_number);
  RasterFile file(mosaic_of(folder / "a.vrt", {image}), {});
  std::filesystem::remove(image);
  const std::string message = testing::message_of([&] { file.read({0, 0, 64, 64}, {}); });
  EXPECT_THAT(message, ::testing::HasSubstr("a.tif"));
  EXPECT_THAT(message, ::testing::HasSubstr("an image that it is made of is missing"));
}

TEST_F(RasterFileTest, AVrtThatComputesItsPixelsInAWayThatIsNotKnownSaysSo) {
  write_raster(folder / "a.tif", {}, band_number);
  const std::string path = (folder / "b.vrt").string();
  std::ofstream(path) << R"(<VRTDataset rasterXSize="64" rasterYSize="64"><SRS>EPSG:32637</SRS>
<GeoTransform>400000,1,0,4200064,0,-1</GeoTransform>
<VRTRasterBand dataType="Byte" band="1" subClass="VRTDerivedRasterBand"><PixelFunctionType>mine</PixelFunctionType>
<SimpleSource><SourceFilename relativeToVRT="1">a.tif</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>)";
  RasterFile file(path, {});
  EXPECT_THAT(testing::message_of([&] { file.read({0, 0, 8, 8}, {}); }), ::testing::HasSubstr("gdal_translate"));
}

TEST_F(RasterFileTest, ProgressiveJpegsMayTakeAllMemoryUnlessTheEnvironmentForbidsIt) {
  const RasterSpec spec{.width = 2000, .height = 1500, .bands = 3};
  const std::string tif = write_raster(folder / "a.tif", spec, band_number);
  const std::string path = (folder / "a.jpg").string();
  CPLStringList options;
  options.SetNameValue("PROGRESSIVE", "YES");
  const DatasetPtr from = open_dataset(tif, GDAL_OF_RASTER);
  GDALDriver* jpeg = GetGDALDriverManager()->GetDriverByName("JPEG");
  DatasetPtr(jpeg->CreateCopy(path.c_str(), from.get(), FALSE, options.List(), nullptr, nullptr)).reset();
  const auto read_whole = [&] { RasterFile(path, {}).read({0, 0, 2000, 1500}, {}); };
  EXPECT_STREQ(CPLGetConfigOption("JPEGMEM", ""), "26000M");
  EXPECT_EQ(code_of(read_whole), "no error");
  setenv("JPEGMEM", "2M", 1);
  const std::string message = testing::message_of(read_whole);
  unsetenv("JPEGMEM");
  EXPECT_THAT(message, ::testing::HasSubstr("allow it with the environment variable JPEGMEM"));
}

TEST_F(RasterFileTest, ATruncatedImageFailsAtTheBlockThatIsMissing) {
  const std::string path = write_raster(folder / "a.tif", {.width = 512, .height = 512, .creation = {"TILED=YES"}},
                                        [](int, int col, int row) { return (col * 7 + row * 13) % 251; });
  std::filesystem::resize_file(path, std::filesystem::file_size(path) * 6 / 10);
  RasterFile file(path, {});
  EXPECT_EQ(code_of([&] { file.read({0, 0, 512, 512}, {}); }), "image-unreadable-block");
}

}  // namespace
}  // namespace roadfix
