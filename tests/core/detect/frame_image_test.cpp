#include "core/detect/frame_image.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/support/code_of.hpp"
#include "tests/support/noise.hpp"

namespace roadfix {
namespace {

using testing::noise;

TEST(FrameImage, BlackThatReachesTheRimWasNotSeenAndBlackInsideWas) {
  cv::Mat frame = noise({60, 40}, CV_8UC3);
  frame(cv::Rect(0, 0, 10, 20)).setTo(cv::Scalar(0, 2, 4));
  frame(cv::Rect(30, 15, 8, 8)).setTo(cv::Scalar::all(0));
  const FramePixels image = frame_image(frame, Border::kBlackUnseen);
  EXPECT_EQ(image.observed.at<unsigned char>(10, 5), 0);
  EXPECT_EQ(image.observed.at<unsigned char>(20, 10), 255);
  EXPECT_EQ(image.observed.at<unsigned char>(18, 33), 255);
  EXPECT_EQ(cv::countNonZero(image.observed), 60 * 40 - 10 * 20);
}

TEST(FrameImage, BlackThatFillsNoCornerWasSeenUnlessSaidOtherwise) {
  cv::Mat frame = noise({60, 40}, CV_8UC3);
  frame(cv::Rect(20, 0, 10, 30)).setTo(cv::Scalar::all(0));
  EXPECT_EQ(cv::countNonZero(frame_image(frame).observed), 60 * 40);
  EXPECT_EQ(cv::countNonZero(frame_image(frame, Border::kBlackUnseen).observed), 60 * 40 - 10 * 30);
}

TEST(FrameImage, AlphaSaysWhatWasSeen) {
  cv::Mat frame(8, 8, CV_8UC4, cv::Scalar(10, 20, 30, 255));
  frame.at<cv::Vec4b>(2, 3)[3] = 0;
  frame.at<cv::Vec4b>(3, 3)[3] = 127;  // less than half of it
  frame.at<cv::Vec4b>(4, 3)[3] = 128;
  const FramePixels image = frame_image(frame);
  EXPECT_EQ(image.pixels.type(), CV_8UC3);
  EXPECT_EQ(image.pixels.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(cv::countNonZero(image.observed), 62);
}

/// Grey that grows with the columns, from `first` in steps.
cv::Mat ramp(int first, int step) {
  cv::Mat frame(10, 256, CV_16UC1);
  for (int col = 0; col < frame.cols; ++col) frame.col(col).setTo(cv::Scalar(first + step * col));
  return frame;
}

TEST(FrameImage, SixteenBitsShowTheSameWhateverPartOfThemASensorFills) {
  const cv::Mat full = frame_image(ramp(0, 257)).pixels;
  EXPECT_EQ(full.type(), CV_8UC1);
  for (const cv::Mat& frame : {ramp(0, 16), ramp(7000, 2)}) {
    cv::Mat difference;
    cv::absdiff(frame_image(frame).pixels, full, difference);
    EXPECT_EQ(cv::countNonZero(difference > 1), 0);
  }
  EXPECT_EQ(full.at<unsigned char>(0, 0), 0);
  EXPECT_NEAR(full.at<unsigned char>(0, 64), 64, 1);
  EXPECT_EQ(full.at<unsigned char>(0, 255), 255);
}

TEST(FrameImage, OfSixteenBitsTheDarkGroundAtTheRimWasSeenAndNothingElseIsBlack) {
  cv::Mat frame = ramp(7000, 2);
  frame.rowRange(0, 5).setTo(cv::Scalar(0));
  const FramePixels image = frame_image(frame, Border::kBlackUnseen);
  EXPECT_EQ(cv::countNonZero(image.observed), 5 * 256);
  EXPECT_NEAR(image.pixels.at<unsigned char>(9, 128), 128, 1) << "what was not seen does not count";
  EXPECT_EQ(cv::countNonZero(frame_image(ramp(1, 2), Border::kBlackUnseen).observed), 10 * 256);
}

TEST(FrameImage, SixteenBitsOfOneValueOrNoneThatWasSeenMakeAPicture) {
  EXPECT_EQ(frame_image(cv::Mat(4, 4, CV_16UC1, cv::Scalar(0x8000))).pixels.type(), CV_8UC1);
  const FramePixels unseen = frame_image(cv::Mat(4, 4, CV_16UC4, cv::Scalar(9, 9, 9, 0x7FFF)));
  EXPECT_EQ(unseen.pixels.type(), CV_8UC3);
  EXPECT_EQ(cv::countNonZero(unseen.observed), 0);
  EXPECT_EQ(cv::countNonZero(frame_image(cv::Mat(4, 4, CV_16UC4, cv::Scalar(9, 9, 9, 0x8000))).observed), 16);
}

TEST(FrameImage, RefusesOtherPictures) {
  for (const cv::Mat& other : {cv::Mat(), cv::Mat(4, 4, CV_32FC1), cv::Mat(4, 4, CV_8UC2)}) {
    EXPECT_EQ(testing::code_of([&] { frame_image(other); }), "image-shape") << other.type();
  }
}

}  // namespace
}  // namespace roadfix
