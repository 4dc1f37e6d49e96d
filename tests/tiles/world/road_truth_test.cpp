#include "tiles/world/road_truth.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace roadfix::world {
namespace {

/// Points on the rim come out a rounding beside it on some processors.
void expect_line(const Polyline& line, const Polyline& expected) {
  ASSERT_EQ(line.size(), expected.size());
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_LT(cv::norm(line[i] - expected[i]), 1e-9) << "point " << i;
}

TEST(RoadTruth, CutsLinesAtTheRimOfThePicture) {
  const auto parts = clipped({{-10, 5}, {5, 5}, {5, 30}, {8, 30}, {8, 5}, {9, 6}}, 20, 10);
  ASSERT_EQ(parts.size(), 2U);
  expect_line(parts[0], {{0, 5}, {5, 5}, {5, 10}});
  expect_line(parts[1], {{8, 10}, {8, 5}, {9, 6}});
}

TEST(RoadTruth, LeavesLinesWithinThePictureWhole) {
  Polyline line;
  for (int i = 0; i < 100; ++i) line.emplace_back(10.0 + 9.9 * std::sin(i), 5.0 + 4.9 * std::cos(1.7 * i));
  const auto parts = clipped(line, 20, 10);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0], line);
}

TEST(RoadTruth, LeavesOutLinesThatPassThePictureBy) {
  EXPECT_TRUE(clipped({{-5, -5}, {-5, 50}}, 20, 10).empty());
  EXPECT_TRUE(clipped({{-4, 5}, {4, -6}}, 20, 10).empty());
}

}  // namespace
}  // namespace roadfix::world
