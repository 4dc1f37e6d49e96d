#include "core/detect/sketch.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace roadfix {
namespace {

/// Ground of smooth noise, as large as a picture and a little more to its right.
cv::Mat ground() {
  cv::Mat3b all(480, 700);
  cv::RNG(5).fill(all, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(all, all, {}, 6.0);
  cv::normalize(all, all, 40.0, 210.0, cv::NORM_MINMAX);
  return all;
}

cv::Mat seen_after(int px) { return ground()(cv::Rect(px, 0, 640, 480)).clone(); }

cv::Mat encoded_anew(const cv::Mat& picture, int quality, double noise, const std::string& text) {
  cv::Mat noisy(picture.size(), CV_16SC3);
  cv::RNG(static_cast<std::uint64_t>(quality)).fill(noisy, cv::RNG::NORMAL, 0.0, noise);
  cv::add(picture, noisy, noisy, {}, CV_16S);
  noisy.convertTo(noisy, CV_8U);
  cv::putText(noisy, text, {20, 40}, cv::FONT_HERSHEY_SIMPLEX, 1.0, cv::Scalar::all(255), 2);
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", noisy, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(jpeg, cv::IMREAD_UNCHANGED);
}

TEST(Sketch, IsThatOfTheSamePictureThoughItIsEncodedAnewLighterAndWithAnotherTime) {
  const cv::Mat picture = seen_after(0);
  const PictureSketch sketch = sketch_of(encoded_anew(picture, 95, 2.0, "12:34:56 ALT 150"));
  const PictureSketch later = sketch_of(encoded_anew(1.1 * picture + cv::Scalar::all(5), 30, 10.0, "12:35:07 ALT 148"));
  EXPECT_NE(later, sketch);
  EXPECT_TRUE(is_same_picture(later, sketch));
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  EXPECT_TRUE(is_same_picture(sketch_of(grey), sketch));
}

TEST(Sketch, IsAnotherOnceTheVehicleHasMovedThoughTextStaysInPlace) {
  const auto sketch_after = [](int px) { return sketch_of(encoded_anew(seen_after(px), 95, 0.0, "12:34:56 ALT 150")); };
  EXPECT_TRUE(is_same_picture(sketch_after(0), sketch_after(0)));
  EXPECT_FALSE(is_same_picture(sketch_after(0), sketch_after(10)));
  EXPECT_FALSE(is_same_picture(sketch_after(0), sketch_after(30)));
}

TEST(Sketch, OfACalmSeaWithTextOnTheScreenTellsNothing) {
  const cv::Mat sea(480, 640, CV_8UC3, cv::Scalar(120, 90, 60));
  const PictureSketch sketch = sketch_of(encoded_anew(sea, 95, 1.0, "12:34:56 ALT 150"));
  EXPECT_FALSE(is_same_picture(sketch, sketch));
}

TEST(Sketch, IsOfTheWholePictureHoweverSmall) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 200), cv::Size(64, 64)}) {
    EXPECT_EQ(sketch_of(cv::Mat(size, CV_8UC1, cv::Scalar(7))), PictureSketch{}) << size;
  }
}

}  // namespace
}  // namespace roadfix
