#include "core/detect/growing_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

cv::Mat seen(const cv::Mat& image) { return {image.size(), CV_8UC1, cv::Scalar(255)}; }

cv::Mat noise(int size, unsigned seed) {
  cv::Mat image(size, size, CV_8UC1);
  cv::RNG rng(seed);
  rng.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

/// A grey road 9 px wide across a noisy field.
cv::Mat road_picture() {
  cv::Mat image = noise(200, 3);
  cv::line(image, {0, 60}, {199, 140}, cv::Scalar(128), 9);
  return image;
}

// Equation (3) by hand: along the row the levels are 10 20 15 15 40.
TEST(BrightnessVariation, AddsTheStepsAlongTheSegment) {
  const cv::Mat row = (cv::Mat_<uchar>(1, 5) << 10, 20, 15, 15, 40);
  EXPECT_EQ(brightness_variation(row, seen(row), {0, 0}, {4, 0}), 10 + 5 + 0 + 25);
  EXPECT_EQ(brightness_variation(row, seen(row), {4, 0}, {0, 0}), 40);
  EXPECT_EQ(brightness_variation(row, seen(row), {2, 0}, {2, 0}), 0);
}

TEST(BrightnessVariation, EndsAtTheBorderAndAtUnobservedPixels) {
  const cv::Mat row = (cv::Mat_<uchar>(1, 5) << 10, 20, 15, 15, 40);
  cv::Mat observed = seen(row);
  EXPECT_FALSE(brightness_variation(row, observed, {0, 0}, {5, 0}));
  observed.at<uchar>(0, 2) = 0;
  EXPECT_FALSE(brightness_variation(row, observed, {0, 0}, {4, 0}));
}

TEST(NodeScore, FollowsEquationOne) {
  TreeParameters p;
  p.alpha = 0.3;
  p.beta = 2.0;
  p.epsilon = 0.5;
  const double cosine = std::sqrt(3.0) / 2.0;  // of 30 degrees
  EXPECT_NEAR(node_score(p, Angle::degrees(50), Angle::degrees(20), 4.0, 0.2), 0.3 * cosine * cosine / 4.5 + 0.7 * 0.2,
              1e-12);
  EXPECT_NEAR(node_score(p, Angle::degrees(-175), Angle::degrees(155), 4.0, 0.2),
              0.3 * cosine * cosine / 4.5 + 0.7 * 0.2, 1e-12);
  EXPECT_NEAR(node_score(p, Angle::degrees(120), Angle::degrees(20), 4.0, 0.2), 0.7 * 0.2, 1e-12)
      << "beyond 90 degrees the cosine is 0";
}

TEST(RunningMean, FollowsEquationTwoAcrossTheCut) {
  TreeParameters p;
  p.gamma = 0.25;
  EXPECT_NEAR(running_mean(p, Angle::degrees(40), Angle::degrees(20)).degrees(), 0.25 * 40 + 0.75 * 20, 1e-9);
  EXPECT_NEAR(running_mean(p, Angle::degrees(-170), Angle::degrees(170)).degrees(), 175, 1e-9);
}

TEST(GrowTree, EveryNodeKeepsTheEquations) {
  const cv::Mat image = road_picture();
  const TreeParameters p;
  const RoadTree tree = grow_tree(image, seen(image), {100, 100}, p);
  ASSERT_EQ(tree.nodes.size(), 200u);
  EXPECT_EQ(tree.end, TreeEnd::kNodes);
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    ASSERT_LT(node.parent, static_cast<int>(i));
    const TreeNode& parent = tree.nodes[static_cast<std::size_t>(node.parent)];
    const Angle parent_mean = node.parent == 0 ? node.direction : parent.mean_direction;
    const auto variation = brightness_variation(image, seen(image), parent.position, node.position);
    ASSERT_TRUE(variation);
    EXPECT_NEAR(node.score, node_score(p, node.direction, parent_mean, *variation, parent.score), 1e-12);
    EXPECT_NEAR(angular_distance(node.mean_direction, running_mean(p, node.direction, parent_mean)).degrees(), 0, 1e-9);
    EXPECT_NEAR(cv::norm(node.position - parent.position), p.edge_px, 1e-9);
  }
}

TEST(GrowTree, FollowsASmoothRoadThroughNoise) {
  const cv::Mat image = road_picture();
  TreeParameters p;
  p.max_nodes = 40;
  cv::Mat road = cv::Mat::zeros(image.size(), CV_8UC1);
  cv::line(road, {0, 60}, {199, 140}, cv::Scalar(255), 13);
  int on_road = 0;
  const RoadTree tree = grow_tree(image, seen(image), {100, 100}, p);
  for (const TreeNode& node : tree.nodes) on_road += road.at<uchar>(cv::Point(node.position)) != 0;
  // The road covers 7 % of the picture.
  EXPECT_GT(on_road, static_cast<int>(0.4 * static_cast<double>(tree.nodes.size())));
}

TEST(GrowTree, StaysOnObservedPixels) {
  const cv::Mat image = road_picture();
  cv::Mat observed = seen(image);
  observed.colRange(120, 200).setTo(0);
  for (const TreeNode& node : grow_tree(image, observed, {100, 100}, {}).nodes) EXPECT_LT(node.position.x, 119.5);
  EXPECT_TRUE(grow_tree(image, observed, {150, 100}, {}).nodes.empty());
}

TEST(GrowTree, EndsByEachOfTheFourCriteria) {
  const cv::Mat image = road_picture();
  TreeParameters share;
  share.max_nodes.reset();
  share.edge_px = 6.0;
  share.max_explored_share = 0.05;
  const RoadTree by_share = grow_tree(image, seen(image), {100, 100}, share);
  EXPECT_EQ(by_share.end, TreeEnd::kExploredShare);
  EXPECT_NEAR(static_cast<double>(by_share.nodes.size()) * 9.0, 0.05 * 200 * 200,
              16 * 9.0);  // a node explores (edge / 2)^2 px

  TreeParameters area;
  area.max_nodes.reset();
  area.max_area_px = 1500;
  EXPECT_EQ(grow_tree(image, seen(image), {100, 100}, area).end, TreeEnd::kArea);

  TreeParameters score;
  score.max_nodes = 100000;
  score.min_score = 0.02;
  const RoadTree by_score = grow_tree(image, seen(image), {100, 100}, score);
  EXPECT_EQ(by_score.end, TreeEnd::kExhausted);
  for (std::size_t i = 1; i < by_score.nodes.size(); ++i) EXPECT_GE(by_score.nodes[i].score, 0.02);
}

TEST(Validate, NamesTheParameter) {
  const auto code_of = [](auto change) {
    TreeParameters p;
    change(p);
    try {
      validate(p);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(code_of([](auto& p) { p.beta = 0.7; }).find("beta"), std::string::npos);
  EXPECT_NE(code_of([](auto& p) { p.alpha = std::nan(""); }).find("alpha"), std::string::npos);
  EXPECT_NE(code_of([](auto& p) { p.epsilon = 0; }).find("epsilon"), std::string::npos);
  EXPECT_NE(code_of([](auto& p) { p.max_nodes.reset(); }).find("one of"), std::string::npos);
  EXPECT_EQ(code_of([](auto&) {}), "");
}

}  // namespace
}  // namespace roadfix
