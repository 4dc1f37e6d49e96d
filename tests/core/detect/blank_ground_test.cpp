#include "core/detect/blank_ground.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

namespace roadfix {
namespace {

/// Ground of at least 4 levels of contrast in every 2 x 2 pixels, all of it observed.
GroundImage ground(cv::Size size, double gsd_m, int channels = 3) {
  GroundImage image{cv::Mat(size, CV_8UC(channels)), cv::Mat(size, CV_8UC1, cv::Scalar(255)), gsd_m};
  for (int row = 0; row < size.height; ++row) {
    for (int col = 0; col < size.width; ++col) {
      image.pixels(cv::Rect(col, row, 1, 1)).setTo(cv::Scalar::all(100 + 4 * ((col + row) % 2)));
    }
  }
  return image;
}

bool observed(const GroundImage& image, int col, int row) { return image.observed.at<unsigned char>(row, col) != 0; }

/// All of `rect` is not observed, and nothing that is more than `around` pixels away from it.
void expect_excluded(const GroundImage& image, const cv::Rect& rect, int around) {
  const cv::Rect near(rect.x - around, rect.y - around, rect.width + 2 * around, rect.height + 2 * around);
  for (int row = 0; row < image.observed.rows; ++row) {
    for (int col = 0; col < image.observed.cols; ++col) {
      const bool seen = observed(image, col, row);
      ASSERT_FALSE(seen && rect.contains({col, row})) << col << ' ' << row;
      ASSERT_TRUE(seen || near.contains({col, row})) << col << ' ' << row;
    }
  }
}

TEST(BlankGround, OfAnyColourAndAtAnyEdgeWasNotSeen) {
  for (const cv::Scalar& colour : {cv::Scalar(255, 255, 255), cv::Scalar(0, 0, 0), cv::Scalar(180, 120, 60)}) {
    for (const cv::Rect& rect : {cv::Rect(0, 0, 50, 200), cv::Rect(170, 0, 30, 200), cv::Rect(90, 61, 45, 37)}) {
      GroundImage image = ground({200, 200}, 1.0);
      image.pixels(rect).setTo(colour);
      exclude_blank(image);
      expect_excluded(image, rect, 8);
    }
  }
}

TEST(BlankGround, IsGroundOf16MetresAtAnyPixelSize) {
  for (const double gsd_m : {0.1, 0.25, 0.5, 1.0}) {
    const auto pixels = [gsd_m](double side_m) { return static_cast<int>(side_m / gsd_m); };
    for (const auto& [side_m, seen] : {std::pair{12.0, true}, {24.0, false}}) {
      GroundImage image = ground({pixels(100), pixels(100)}, gsd_m);
      const cv::Rect roof(pixels(40), pixels(40), pixels(side_m), pixels(side_m));
      image.pixels(roof).setTo(cv::Scalar::all(250));
      exclude_blank(image);
      EXPECT_EQ(observed(image, roof.x + roof.width / 2, roof.y + roof.height / 2), seen) << gsd_m << ' ' << side_m;
    }
  }
}

TEST(BlankGround, OfCoarsePixelsNeedsSixteenOfThemASide) {
  GroundImage image = ground({60, 60}, 5.0);
  image.pixels(cv::Rect(4, 4, 12, 12)).setTo(cv::Scalar::all(30));
  image.pixels(cv::Rect(24, 24, 24, 24)).setTo(cv::Scalar::all(30));
  exclude_blank(image);
  EXPECT_TRUE(observed(image, 10, 10));
  EXPECT_FALSE(observed(image, 36, 36));
}

TEST(BlankGround, MayVaryByTheRoundingOfALossyCodecAndNoMore) {
  for (const auto& [levels, seen] : {std::pair{1, false}, {2, true}}) {
    GroundImage image = ground({100, 100}, 1.0, 1);
    for (int col = 0; col < 60; ++col) image.pixels.col(col).setTo(cv::Scalar(200 + col % 2 * levels));
    exclude_blank(image);
    EXPECT_EQ(observed(image, 30, 50), seen) << levels;
  }
}

TEST(BlankGround, IsJudgedByWhatWasObserved) {
  GroundImage image = ground({100, 100}, 1.0, 1);
  image.observed.colRange(0, 30).setTo(0);  // has contrast, but was not seen
  image.pixels.colRange(30, 44).setTo(cv::Scalar(7));
  image.observed.at<unsigned char>(90, 10) = 255;  // a pixel alone says nothing of blank ground
  exclude_blank(image);
  EXPECT_FALSE(observed(image, 36, 50)) << "what is left of a collar beside what is marked as nodata";
  EXPECT_TRUE(observed(image, 10, 90));
  EXPECT_TRUE(observed(image, 60, 50));
}

TEST(BlankGround, LeavesTheMaskOfACopyAlone) {
  GroundImage image = ground({100, 100}, 1.0);
  image.pixels.colRange(0, 50).setTo(cv::Scalar::all(0));
  const GroundImage copy = image;
  exclude_blank(image);
  EXPECT_EQ(cv::countNonZero(copy.observed), 100 * 100);
}

TEST(BlankGround, IsFoundAroundWhatAnotherPictureAddsAsInAllOfTheView) {
  std::mt19937 random(5);
  const auto below = [&](int limit) { return std::uniform_int_distribution(0, limit - 1)(random); };
  for (int view = 0; view < 20; ++view) {
    GroundImage image = ground({200, 150}, 1.0);
    for (int third = 0; third < 3; ++third) {
      const cv::Rect roof(third * 67, below(90), 10 + below(50), 10 + below(50));
      image.pixels(roof).setTo(cv::Scalar::all(30 + third * 70));
    }
    image.observed.setTo(0);
    for (int added = 0; added < 8; ++added) {
      const cv::Rect part = cv::Rect(below(200), below(150), 1 + below(120), 1 + below(120)) & cv::Rect(0, 0, 200, 150);
      image.observed(part).setTo(255);
      GroundImage all = image;
      exclude_blank(all);
      exclude_blank(image, part);
      ASSERT_EQ(cv::countNonZero(image.observed != all.observed), 0) << view << ' ' << added;
    }
  }
}

}  // namespace
}  // namespace roadfix
