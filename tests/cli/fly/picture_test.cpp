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

}  // namespace
}  // namespace roadfix::fly
