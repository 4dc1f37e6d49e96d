// Images far from each other in a VRT, or in a file that holds nothing else, as those of a region's towns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/place.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/imagery/mosaic.hpp"

namespace roadfix {
namespace {

using testing::kZone;
using testing::mosaic_of;
using testing::write_raster;

class MosaicGaps : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
};

TEST_F(MosaicGaps, AreTouchedByNoBlockButAllThatTheImagesShowIs) {
  // Pixels of about a metre in degrees, which lie turned by a degree or so on the map's plane.
  const auto town = [&](const char* name, double lon, double lat) {
    testing::RasterSpec spec{.width = 900, .height = 700, .epsg = 4326};
    spec.transform = {lon, 1e-5, 0.0, lat, 0.0, -1e-5};
    return write_raster(folder / name, spec, [](int, int col, int row) { return 40 + (col * 7 + row * 3) % 90; });
  };
  const std::vector<std::string> towns{town("a.tif", 37.0, 38.0), town("b.tif", 37.1, 38.05)};
  const Mosaic apart(towns, {}, ValueRule::kPicture, kZone);
  const Mosaic mosaic({mosaic_of(folder / "towns.vrt", towns)}, {}, ValueRule::kPicture, kZone);
  constexpr double kBlockM = 256.0;
  int touched = 0;
  int showing = 0;
  const GridBox all = mosaic.extent();
  for (double north = all.min.north_m; north < all.max.north_m; north += kBlockM) {
    for (double east = all.min.east_m; east < all.max.east_m; east += kBlockM) {
      const GridBox block{{east, north}, {east + kBlockM, north + kBlockM}};
      const bool shows = cv::countNonZero(apart.view(block, 4.0).observed) > 0;
      EXPECT_TRUE(mosaic.touches(block) || !shows) << east << ' ' << north;
      touched += mosaic.touches(block) ? 1 : 0;
      showing += shows ? 1 : 0;
    }
  }
  EXPECT_GT(showing, 20);
  EXPECT_LE(touched, 2 * showing);
}

TEST_F(MosaicGaps, LeaveTheRangeOfValuesThatOfTheImages) {
  // Bright in the middle, which corners of the VRT do not show.
  const auto image = [&](const char* name, double off_m) {
    testing::RasterSpec spec{.width = 301, .height = 301, .type = GDT_UInt16};
    spec.transform = {400000.0 + off_m, 1.0, 0.0, 4200000.0 - off_m, 0.0, -1.0};
    return write_raster(folder / name, spec, [](int, int col, int row) {
      return 2300 - 2000 * std::max(std::abs(col - 150), std::abs(row - 150)) / 150;
    });
  };
  const Mosaic mosaic({mosaic_of(folder / "towns.vrt", {image("a.tif", 0), image("b.tif", 130'000)})}, {},
                      ValueRule::kPicture, kZone);
  EXPECT_NEAR(mosaic.range().low, 300.0, 50.0);
  EXPECT_NEAR(mosaic.range().high, 2300.0, 200.0);
}

TEST_F(MosaicGaps, OfBlocksThatAFileLeavesOutAreTouchedByNoBlockOfAMap) {
  testing::RasterSpec spec{.width = 4096, .height = 4096, .nodata = 0};
  spec.creation = {"TILED=YES", "SPARSE_OK=TRUE"};
  const auto town = [](int, int col, int row) { return col < 300 && row < 200 ? 40 + (col + row) % 90 : 0; };
  const std::string path = write_raster(folder / "town.tif", spec, town);
  const Mosaic mosaic({path}, {}, ValueRule::kPicture, kZone);
  const GridPoint corner{mosaic.extent().min.east_m, mosaic.extent().max.north_m};
  const GridBox on_town{{corner.east_m, corner.north_m - 256.0}, {corner.east_m + 256.0, corner.north_m}};
  EXPECT_TRUE(mosaic.touches(on_town));
  EXPECT_GT(cv::countNonZero(mosaic.view(on_town, 1.0).observed), 256 * 190);
  EXPECT_FALSE(mosaic.touches(
      {{corner.east_m + 3000.0, corner.north_m - 3500.0}, {corner.east_m + 3500.0, corner.north_m - 3000.0}}));
}

TEST_F(MosaicGaps, OfBlocksThatAFileLeavesOutAreSeenWhereZeroIsAValue) {
  testing::RasterSpec spec{.width = 4096, .height = 4096};
  spec.creation = {"TILED=YES", "SPARSE_OK=TRUE"};
  const auto roads = [](int, int col, int row) { return col < 300 && row < 200 ? 255 : 0; };
  const Mosaic mosaic({write_raster(folder / "roads.tif", spec, roads)}, {}, ValueRule::kShare, kZone);
  const GridPoint corner{mosaic.extent().min.east_m, mosaic.extent().max.north_m};
  const GridBox beside{{corner.east_m + 3000.0, corner.north_m - 3500.0},
                       {corner.east_m + 3500.0, corner.north_m - 3000.0}};
  ASSERT_TRUE(mosaic.touches(beside));
  EXPECT_EQ(cv::countNonZero(mosaic.view(beside, 2.0).observed), 250 * 250);
}

TEST_F(MosaicGaps, OfAFileLeaveTheRangeOfValuesThatOfItsTown) {
  const testing::RasterSpec spec{.width = 2000, .height = 2000, .type = GDT_UInt16, .nodata = 0};
  const auto within = [](int at) { return at >= 80 && at < 110; };  // between the windows that are sampled
  const auto town = [&](int, int col, int row) { return within(col) && within(row) ? 500 + 10 * (col + row) : 0; };
  const Mosaic mosaic({write_raster(folder / "town.tif", spec, town)}, {}, ValueRule::kPicture, kZone);
  EXPECT_NEAR(mosaic.range().low, 500.0 + 10.0 * 160, 100.0);
  EXPECT_NEAR(mosaic.range().high, 500.0 + 10.0 * 218, 100.0);
}

}  // namespace
}  // namespace roadfix
