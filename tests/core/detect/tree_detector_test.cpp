#include "core/detect/tree_detector.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>

#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

/// Two crossing roads of 9 m through noise, at 1 m.
GroundImage crossing() {
  cv::Mat image(300, 300, CV_8UC1);
  cv::RNG rng(5);
  rng.fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::line(image, {150, 0}, {150, 299}, cv::Scalar(128), 9);
  cv::line(image, {0, 200}, {299, 200}, cv::Scalar(128), 9);
  return {image, cv::Mat(300, 300, CV_8UC1, cv::Scalar(255)), 1.0};
}

double mean_probability(const CellArray& cells, cv::Rect area) {
  double sum = 0.0;
  for (int row = area.y; row < area.br().y; ++row) {
    for (int col = area.x; col < area.br().x; ++col) sum += probability(cells.at(col, row));
  }
  return sum / area.area();
}

TEST(TreeRoadDetector, RaisesTheProbabilityOfRoads) {
  const CellArray cells = TreeRoadDetector().detect(crossing(), 3.0, 1);
  ASSERT_EQ(cells.cols(), 100);
  const double road = mean_probability(cells, {49, 0, 3, 60});
  const double field = mean_probability(cells, {0, 0, 45, 60});
  EXPECT_GT(road, 2.0 * field);
}

TEST(TreeRoadDetector, MakesThePapersBinaryMap) {
  TreeDetectorOptions options;
  options.map = TreeDetectorOptions::Map::kBinary;
  const GroundImage image = crossing();
  const CellArray cells = TreeRoadDetector(options).detect(image, 10.0, 1);
  const TreeCounts counts = count_trees(image, 10.0, options, 1);
  for (int row = 0; row < 30; ++row) {
    for (int col = 0; col < 30; ++col)
      EXPECT_EQ(cells.at(col, row), counts.nodes.at<int>(row, col) >= 3 ? kRoad : kNoRoad);
  }
}

TEST(TreeRoadDetector, KeepsUnobservedUnobserved) {
  GroundImage image = crossing();
  image.observed.colRange(0, 150).setTo(0);
  const CellArray cells = TreeRoadDetector().detect(image, 3.0, 1);
  EXPECT_EQ(cells.at(10, 10), kUnobserved);
  EXPECT_NE(cells.at(60, 10), kUnobserved);
  image.observed.setTo(0);
  EXPECT_EQ(TreeRoadDetector().detect(image, 3.0, 1).observed_count(), 0u);
}

TEST(TreeRoadDetector, DependsOnItsSeedAlone) {
  const TreeRoadDetector detector;
  EXPECT_EQ(detector.detect(crossing(), 3.0, 1), detector.detect(crossing(), 3.0, 1));
  EXPECT_FALSE(detector.detect(crossing(), 3.0, 1) == detector.detect(crossing(), 3.0, 2));
}

TEST(TreeRoadDetector, EndsWhenAskedTo) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(testing::code_of([&] { TreeRoadDetector().detect(crossing(), 3.0, 1, stop.get_token()); }),
            "detection-interrupted");
}

TEST(CountTrees, ATreeReachesACellNoOftenerThanItsNodes) {
  const TreeCounts counts = count_trees(crossing(), 3.0, {}, 1);
  EXPECT_EQ(cv::countNonZero(counts.trees > counts.nodes), 0);
  EXPECT_EQ(cv::countNonZero((counts.nodes > 0) != (counts.trees > 0)), 0);
  const double expected = 3000 * 0.09 * 200;  // trees x nodes
  EXPECT_LE(cv::sum(counts.nodes)[0], expected);
  EXPECT_GT(cv::sum(counts.nodes)[0], 0.8 * expected);
}

TEST(TreeRoadDetector, DescribesItselfAsMapsHaveIt) {
  const std::string parameters =
      " gsd_m=0.5 trees_per_km2=3000 min_nodes=3 alpha=0.5 beta=0.8 gamma=0.5 epsilon=4 edge_px=12 fan=7 "
      "fan_half_width_deg=40 root_fan=16 max_nodes=200 max_explored_share=- max_area_px=- min_score=-";
  TreeDetectorOptions options;
  EXPECT_EQ(TreeRoadDetector(options).describe(), "tree map=probabilistic" + parameters);
  options.map = TreeDetectorOptions::Map::kBinary;
  EXPECT_EQ(TreeRoadDetector(options).describe(), "tree map=binary" + parameters);
}

}  // namespace
}  // namespace roadfix
