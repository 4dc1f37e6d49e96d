#include "cli/fly/picture.hpp"

#include <gtest/gtest.h>

#include "tests/support/map_view.hpp"

namespace roadfix::fly {
namespace {

TEST(Backdrop, LeavesTheImageryThatTheVehicleLooksAtAsItWas) {
  const RoadGrid town = testing::street_map(3, {2.0, {200'000, -2'000'000}, 100, 100});
  const MapView map = testing::view_of(town);
  Orthoimage imagery;
  imagery.image.pixels = cv::Mat(400, 400, CV_8UC3);
  cv::randu(imagery.image.pixels, 0, 255);
  imagery.image.observed = cv::Mat(400, 400, CV_8UC1, cv::Scalar::all(255));
  imagery.image.gsd_m = 0.5;
  imagery.north_west = {map.extent.min.east_m, map.extent.max.north_m};
  const cv::Mat before = imagery.image.pixels.clone();
  backdrop_of(map, &imagery, 50);
  EXPECT_EQ(cv::norm(imagery.image.pixels, before, cv::NORM_INF), 0.0);
}

TEST(Backdrop, ShowsImageryThatIsWiderThanOpenCvWarps) {
  const RoadGrid plain{{16.0, {20'000, -250'000}, 2500, 10}, CellArray(2500, 10, kNoRoad)};
  const MapView map = testing::view_of(plain);
  Orthoimage imagery;
  imagery.image.pixels = cv::Mat(160, 40'000, CV_8UC1, cv::Scalar::all(50));
  imagery.image.pixels.colRange(20'000, 40'000) = 120;
  imagery.image.observed = cv::Mat(160, 40'000, CV_8UC1, cv::Scalar::all(255));
  imagery.image.observed.colRange(30'000, 40'000) = 0;
  imagery.north_west = {map.extent.min.east_m, map.extent.max.north_m};
  const cv::Mat shown = backdrop_of(map, &imagery, 1000).pixels;
  ASSERT_EQ(shown.size(), cv::Size(1000, 4));
  for (const auto& [col, grey] : {std::pair{0, 50}, {499, 50}, {500, 120}, {749, 120}, {750, 235}, {999, 235}}) {
    for (const int row : {0, 3})
      EXPECT_EQ(shown.at<cv::Vec3b>(row, col), cv::Vec3b::all(static_cast<uchar>(grey))) << col;
  }
}

}  // namespace
}  // namespace roadfix::fly
