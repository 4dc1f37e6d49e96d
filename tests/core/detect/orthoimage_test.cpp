#include "core/detect/orthoimage.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

/// Every pixel holds its own column and row, so that a cut-out tells where it came from.
Orthoimage coordinates(int cols, int rows) {
  Orthoimage ortho;
  ortho.north_west = {1000.0, 2000.0};
  ortho.image.gsd_m = 0.5;
  ortho.image.pixels.create(rows, cols, CV_8UC3);
  ortho.image.observed = cv::Mat(rows, cols, CV_8UC1, cv::Scalar(255));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < cols; ++x) {
      ortho.image.pixels.at<cv::Vec3b>(y, x) = {static_cast<uchar>(x), static_cast<uchar>(y), 0};
    }
  }
  return ortho;
}

TEST(OrthoimageCutOut, NorthUpReturnsThePixelsThemselves) {
  const Orthoimage ortho = coordinates(40, 40);
  const GroundImage cut = cut_out(ortho, {{1010.0, 1990.0}, Angle()}, {5.0, 4.0}, 0.5);
  ASSERT_EQ(cut.pixels.size(), cv::Size(10, 8));
  EXPECT_EQ(cut.pixels.at<cv::Vec3b>(0, 0), cv::Vec3b(15, 16, 0));
  EXPECT_EQ(cut.pixels.at<cv::Vec3b>(7, 9), cv::Vec3b(24, 23, 0));
}

TEST(OrthoimageCutOut, FlyingEastTheForwardEdgeIsEast) {
  const Orthoimage ortho = coordinates(40, 40);
  const GroundImage cut = cut_out(ortho, {{1010.0, 1990.0}, Angle::degrees(90)}, {4.0, 4.0}, 0.5);
  EXPECT_EQ(cut.pixels.at<cv::Vec3b>(0, 0), cv::Vec3b(23, 16, 0));  // front left = north-east
  EXPECT_EQ(cut.pixels.at<cv::Vec3b>(7, 0), cv::Vec3b(16, 16, 0));  // back left = north-west
}

TEST(Orthoimage, SeesItsObservedPixelsAndNothingBeyond) {
  Orthoimage ortho = coordinates(40, 40);
  ortho.image.observed.at<uchar>(3, 2) = 0;
  EXPECT_TRUE(sees(ortho, {1000.1, 1999.9}));
  EXPECT_TRUE(sees(ortho, {1019.9, 1980.1}));
  EXPECT_FALSE(sees(ortho, {1001.2, 1998.3}));  // pixel (2, 3)
  EXPECT_FALSE(sees(ortho, {999.9, 1999.9}));
  EXPECT_FALSE(sees(ortho, {1020.1, 1999.9}));
  EXPECT_FALSE(sees(ortho, {1e300, -1e300}));
}

TEST(OrthoimageCutOut, BeyondTheImageryNothingIsObserved) {
  const Orthoimage ortho = coordinates(40, 40);
  const GroundImage cut = cut_out(ortho, {{1000.0, 2000.0}, Angle()}, {8.0, 8.0}, 0.5);
  EXPECT_EQ(cut.observed.at<uchar>(0, 0), 0);
  EXPECT_EQ(cut.observed.at<uchar>(15, 15), 255);
  EXPECT_EQ(cv::countNonZero(cut.observed), 64);
}

TEST(OrthoimageCutOut, FarBeyondTheImageryNothingIsObserved) {
  const Orthoimage ortho = coordinates(40, 40);
  const GroundImage cut = cut_out(ortho, {{5000.0, -1e9}, Angle()}, {8.0, 4.0}, 0.5);
  EXPECT_EQ(cut.pixels.size(), cv::Size(16, 8));
  EXPECT_EQ(cut.observed.size(), cv::Size(16, 8));
  EXPECT_EQ(cv::countNonZero(cut.observed), 0);
}

TEST(OrthoimageCutOut, OfLessGroundThanAPixelShowsIsOnePixel) {
  const Orthoimage ortho = coordinates(40, 40);
  const GroundImage cut = cut_out(ortho, {{1010.25, 1989.75}, Angle()}, {0.1, 0.2}, 0.5);
  ASSERT_EQ(cut.pixels.size(), cv::Size(1, 1));
  EXPECT_EQ(cut.pixels.at<cv::Vec3b>(0, 0), cv::Vec3b(20, 20, 0));
}

TEST(OrthoimageCutOut, TakesWiderImageryThanOpenCvWarps) {
  const Orthoimage ortho = coordinates(33'000, 40);
  const double east_m = 1000.0 + 32'900 * 0.5;
  const GroundImage cut = cut_out(ortho, {{east_m, 1990.0}, Angle()}, {5.0, 4.0}, 0.5);
  EXPECT_EQ(cut.pixels.at<cv::Vec3b>(0, 0), cv::Vec3b((32'900 - 5) % 256, 16, 0));
  EXPECT_EQ(cv::countNonZero(cut.observed), 80);
}

TEST(Corners, FollowTheHeading) {
  const auto placed = corners({2.0, 4.0}, {{10.0, 20.0}, Angle::degrees(90)});
  EXPECT_NEAR(placed[0].east_m, 12.0, 1e-9);  // front left
  EXPECT_NEAR(placed[0].north_m, 21.0, 1e-9);
  EXPECT_NEAR(placed[2].east_m, 8.0, 1e-9);  // back right
  EXPECT_NEAR(placed[2].north_m, 19.0, 1e-9);
}

}  // namespace
}  // namespace roadfix
