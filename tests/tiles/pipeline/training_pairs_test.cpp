#include "tiles/pipeline/training_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "tests/tiles/roads/road_features.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/roads/vector_roads.hpp"

namespace roadfix {
namespace {

using testing::at;
using testing::feature;
using testing::kCentre;
using testing::kZone;

constexpr double kGsdM = 0.5;

class TrainingPairs : public testing::RoadFeatures {
 protected:
  /// Half a metre per pixel, 256 m wide, around the centre; colours tell the pixel.
  Mosaic imagery() {
    const testing::RasterSpec spec{
        .width = 512,
        .height = 512,
        .bands = 3,
        .transform = std::array<double, 6>{kCentre.east_m - 128.0, kGsdM, 0.0, kCentre.north_m + 128.0, 0.0, -kGsdM}};
    const std::string path = testing::write_raster(folder / "city.tif", spec, [](int band, int col, int row) {
      return band == 1 ? col % 200 + 20 : band == 2 ? row % 200 + 20 : 0;
    });
    return Mosaic({path}, {}, ValueRule::kPicture, kZone);
  }
  /// A street of 8 m from west to east, and the ground that the data cover around the centre.
  std::unique_ptr<CellSource> street(double half_extent_m) {
    const std::string path = geojson({feature(R"("highway":"residential")", at(-300, 10), at(300, 10))});
    VectorOptions options;
    options.extent = testing::extent_around_centre(half_extent_m);
    RoadRules rules;
    rules.set_width_m(8.0);
    return open_road_vectors({path}, options, rules, kZone, kGsdM);
  }
};

TEST_F(TrainingPairs, MaskTheRoadsOfWhatThePictureShows) {
  const Mosaic seen = imagery();
  const auto roads = street(400.0);
  double pixels = 0.0;
  for (const GridGeometry& square : pair_squares(seen, *roads, kGsdM, 256)) {
    const TrainingPair pair = training_pair(seen, *roads, square);
    ASSERT_EQ(pair.picture.size(), cv::Size(256, 256));
    ASSERT_EQ(pair.mask.size(), pair.picture.size());
    pixels += 256.0 * 256.0 * pair.seen;
    for (int row = 0; row < 256; ++row) {
      for (int col = 0; col < 256; ++col) {
        const GridPoint p = square.cell_center(col, row);
        const int image_col = static_cast<int>(std::floor((p.east_m - kCentre.east_m + 128.0) / kGsdM));
        const int image_row = static_cast<int>(std::floor((kCentre.north_m + 128.0 - p.north_m) / kGsdM));
        const bool inside = std::min(image_col, image_row) >= 0 && std::max(image_col, image_row) < 512;
        const cv::Vec3i colour(4, image_row % 200 + 20, image_col % 200 + 20);
        ASSERT_EQ(cv::Vec3i(pair.picture.at<cv::Vec3b>(row, col)), inside ? colour : cv::Vec3i(0, 0, 0));
        const double beside_m = std::abs(p.north_m - (kCentre.north_m + 10.0)) - 4.0;
        if (std::abs(beside_m) < kGsdM) continue;
        ASSERT_EQ(pair.mask.at<std::uint8_t>(row, col), inside && beside_m < 0.0 ? 255 : 0) << col << ' ' << row;
      }
    }
  }
  EXPECT_EQ(pixels, 512.0 * 512.0);
}

TEST_F(TrainingPairs, AreBlackWhereTheRoadDataSayNothing) {
  const Mosaic seen = imagery();
  const auto roads = street(64.0);
  double share = 0.0;
  for (const GridGeometry& square : pair_squares(seen, *roads, kGsdM, 256)) {
    const TrainingPair pair = training_pair(seen, *roads, square);
    share += pair.seen;
    for (int row = 0; row < 256; ++row) {
      for (int col = 0; col < 256; ++col) {
        const GridPoint p = square.cell_center(col, row);
        const double beyond_m =
            std::max(std::abs(p.east_m - kCentre.east_m), std::abs(p.north_m - kCentre.north_m)) - 64.0;
        if (std::abs(beyond_m) < 3.0) continue;  // the box has its edges along meridians
        ASSERT_EQ(pair.picture.at<cv::Vec3b>(row, col) == cv::Vec3b(0, 0, 0), beyond_m > 0.0) << col << ' ' << row;
        ASSERT_TRUE(beyond_m < 0.0 || pair.mask.at<std::uint8_t>(row, col) == 0);
      }
    }
  }
  EXPECT_NEAR(share, 1.0, 0.05);  // 128 m x 128 m
}

TEST_F(TrainingPairs, AreOfNoGroundWhereRoadsLieElsewhere) {
  const Mosaic seen = imagery();
  const std::string path = geojson({feature(R"("highway":"residential")", at(5000, 0), at(5100, 0))});
  EXPECT_TRUE(pair_squares(seen, *open_road_vectors({path}, {}, RoadRules(), kZone, kGsdM), kGsdM, 256).empty());
}

TEST(PairScale, IsAboutThatOfTheImagery) {
  for (const auto& [imagery_m, pairs_m] :
       {std::pair{0.1, 0.5}, {0.5, 0.5}, {0.6, 0.5}, {0.8, 1.0}, {1.0, 1.0}, {2.5, 2.0}}) {
    EXPECT_EQ(pair_gsd_m(imagery_m), pairs_m) << imagery_m;
  }
}

}  // namespace
}  // namespace roadfix
