#include "core/detect/sketch.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace roadfix {

PictureSketch sketch_of(const cv::Mat& pixels) {
  constexpr int kAround = 7;            // parts across, of what a part is compared with
  constexpr float kPlainLevels = 2.5F;  // noise and codecs change the mean of a part by less
  cv::Mat half = pixels;
  if (std::min(pixels.cols, pixels.rows) >= 4 * PictureSketch::kAcross) {
    cv::resize(pixels, half, pixels.size() / 2, 0.0, 0.0, cv::INTER_AREA);  // OpenCV halves much faster
  }
  cv::Mat parts;
  cv::resize(half, parts, {PictureSketch::kAcross, PictureSketch::kAcross}, 0.0, 0.0, cv::INTER_AREA);
  if (parts.channels() == 3) cv::cvtColor(parts, parts, cv::COLOR_BGR2GRAY);
  parts.convertTo(parts, CV_32F);
  cv::Mat around;
  cv::blur(parts, around, {kAround, kAround});
  cv::Mat1f lighter;
  cv::subtract(parts, around, lighter);
  PictureSketch sketch;
  std::size_t i = 0;
  for (const float levels : lighter) {
    sketch.parts[i++] = static_cast<std::int8_t>((levels > kPlainLevels ? 1 : 0) - (levels < -kPlainLevels ? 1 : 0));
  }
  return sketch;
}

}  // namespace roadfix
