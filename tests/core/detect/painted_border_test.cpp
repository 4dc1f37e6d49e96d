#include "core/detect/painted_border.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

#include "tests/support/noise.hpp"

namespace roadfix {
namespace {

using testing::noise;

TEST(PaintedBorder, WasNotSeenBlackOrWhiteAndHoweverThin) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const double colour : {0.0, 255.0}) {
      cv::Mat frame = noise({120, 90}, type);
      const std::vector<cv::Point> wedge{{0, 0}, {119, 0}, {0, 30}};
      cv::fillConvexPoly(frame, wedge, cv::Scalar::all(colour));
      FramePixels image{frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255))};
      exclude_painted_border(image);
      cv::Mat painted(frame.size(), CV_8UC1, cv::Scalar(0));
      cv::fillConvexPoly(painted, wedge, cv::Scalar(255));
      EXPECT_EQ(cv::countNonZero(image.observed & painted), 0);
      EXPECT_GT(cv::countNonZero(image.observed), 0.97 * (120 * 90 - cv::countNonZero(painted)));
    }
  }
}

TEST(PaintedBorder, IsNoDarkOrBrightGroundInACorner) {
  cv::Mat frame = noise({120, 90}, CV_8UC1);
  cv::randu(frame(cv::Rect(0, 0, 60, 40)), 6, 12);
  cv::randu(frame(cv::Rect(60, 50, 60, 40)), 230, 250);
  FramePixels image{frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255))};
  exclude_painted_border(image);
  EXPECT_EQ(cv::countNonZero(image.observed), 120 * 90);
}

TEST(PaintedBorder, IsNoEvenGroundInACorner) {
  cv::Mat frame = noise({120, 90}, CV_8UC3);
  frame(cv::Rect(0, 0, 16, 16)).setTo(cv::Scalar(70, 75, 72));  // asphalt, as a lossy codec leaves it
  FramePixels image{frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255))};
  exclude_painted_border(image);
  EXPECT_EQ(cv::countNonZero(image.observed), 120 * 90);
}

TEST(PaintedBorder, LeavesTheMaskOfACopyAlone) {
  FramePixels image{cv::Mat(90, 120, CV_8UC1, cv::Scalar(0)), cv::Mat(90, 120, CV_8UC1, cv::Scalar(255))};
  const FramePixels copy = image;
  exclude_painted_border(image);
  EXPECT_EQ(cv::countNonZero(image.observed), 0);
  EXPECT_EQ(cv::countNonZero(copy.observed), 120 * 90);
}

}  // namespace
}  // namespace roadfix
