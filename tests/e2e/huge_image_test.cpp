// roadfix ingest of an image of 3.6 gigapixels: memory must not grow with it. Minutes long.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "tests/e2e/child_process.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/test_raster.hpp"

namespace roadfix {
namespace {

using testing::ChildResult;
using testing::RasterSpec;
using testing::write_raster;

/// 60,000 x 60,000 px made of one tile, again and again.
std::string huge_mosaic(const std::filesystem::path& folder, double gsd_m) {
  constexpr int kTile = 2000;
  constexpr int kTiles = 30;
  RasterSpec spec{
      .width = kTile, .height = kTile, .bands = 3, .creation = {"TILED=YES", "COMPRESS=DEFLATE", "ZLEVEL=1"}};
  write_raster(folder / "tile.tif", spec, [](int band, int col, int row) {
    return col % 200 < 20 || row % 250 < 20 ? 200.0 : 40.0 + 10.0 * band;
  });
  const std::string path = folder / "huge.vrt";
  std::ofstream vrt(path);
  vrt << fmt::format(
      "<VRTDataset rasterXSize=\"{0}\" rasterYSize=\"{0}\"><SRS>EPSG:32637</SRS>"
      "<GeoTransform>400000, {1}, 0, 4200000, 0, -{1}</GeoTransform>",
      kTile * kTiles, gsd_m);
  for (int band = 1; band <= 3; ++band) {
    vrt << fmt::format("<VRTRasterBand dataType=\"Byte\" band=\"{}\">", band);
    for (int i = 0; i < kTiles * kTiles; ++i) {
      vrt << fmt::format(
          "<SimpleSource><SourceFilename relativeToVRT=\"1\">tile.tif</SourceFilename><SourceBand>{0}</SourceBand>"
          "<SourceProperties RasterXSize=\"{1}\" RasterYSize=\"{1}\" DataType=\"Byte\" BlockXSize=\"256\" "
          "BlockYSize=\"256\"/><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"{1}\" ySize=\"{1}\"/>"
          "<DstRect xOff=\"{2}\" yOff=\"{3}\" xSize=\"{1}\" ySize=\"{1}\"/></SimpleSource>",
          band, kTile, i % kTiles * kTile, i / kTiles * kTile);
    }
    vrt << "</VRTRasterBand>";
  }
  vrt << "</VRTDataset>";
  return path;
}

TEST(HugeImage, PassesInLessThanTwoGigabytes) {
  const testing::TemporaryFolder folder;
  const std::string path = huge_mosaic(folder.path(), 0.125);  // 7.5 km: fine pixels, so that detection stays short
  const ChildResult result = testing::run_child(
      ROADFIX_PROGRAM,
      {"ingest", path, "--detector", "tree", "--cell", "8", "--jobs", "2", "--json", "--map", folder / "a.gpkg"},
      folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  fmt::print("peak memory {} MiB; {}\n", result.peak_memory_kib / 1024, result.out);
  EXPECT_LT(result.peak_memory_kib, 2L << 20);
}

}  // namespace
}  // namespace roadfix
