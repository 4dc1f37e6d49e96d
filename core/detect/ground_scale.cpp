#include "core/detect/ground_scale.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roadfix {

GroundImage at_gsd(const GroundImage& image, double gsd_m) {
  if (std::abs(gsd_m / image.gsd_m - 1.0) < 1e-6) return image;
  const auto scaled = [&](int size) { return std::max(1, static_cast<int>(std::lround(size * image.gsd_m / gsd_m))); };
  const cv::Size size(scaled(image.pixels.cols), scaled(image.pixels.rows));
  const int interpolation = gsd_m > image.gsd_m ? cv::INTER_AREA : cv::INTER_LINEAR;
  GroundImage result;
  result.gsd_m = gsd_m;
  cv::resize(image.pixels, result.pixels, size, 0, 0, interpolation);
  cv::resize(image.observed, result.observed, size, 0, 0, interpolation);
  cv::threshold(result.observed, result.observed, 127, 255, cv::THRESH_BINARY);
  return result;
}

cv::Mat brightness_of(const cv::Mat& pixels) {
  if (pixels.channels() == 1) return pixels;
  cv::Mat grey;
  cv::cvtColor(pixels, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace roadfix
