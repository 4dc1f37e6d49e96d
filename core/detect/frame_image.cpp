#include "core/detect/frame_image.hpp"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "core/units/error.hpp"

namespace roadfix {

GroundImage frame_image(const cv::Mat& decoded, double gsd_m, Border border) {
  cv::Mat pixels = decoded;
  if (pixels.depth() == CV_16U) pixels.convertTo(pixels, CV_8U, 1.0 / 256.0);
  const int channels = pixels.channels();
  if (pixels.empty() || pixels.depth() != CV_8U || (channels != 1 && channels != 3 && channels != 4)) {
    throw InvalidInput("image-shape",
                       fmt::format("A frame of {} x {} pixels with {} channels: give 8 or 16 bits of grey, "
                                   "BGR or BGR with alpha.",
                                   decoded.cols, decoded.rows, channels));
  }
  GroundImage image{pixels, cv::Mat(pixels.size(), CV_8UC1, cv::Scalar(255)), gsd_m};
  if (channels == 4) {
    cv::extractChannel(pixels, image.observed, 3);
    cv::threshold(image.observed, image.observed, 127, 255, cv::THRESH_BINARY);
    cv::cvtColor(pixels, image.pixels, cv::COLOR_BGRA2BGR);
  }
  if (border == Border::kBlackUnseen) image.observed &= seen_inside_black_border(image.pixels);
  return image;
}

cv::Mat seen_inside_black_border(const cv::Mat& pixels, int darkest) {
  cv::Mat black;
  cv::inRange(pixels, cv::Scalar::all(0), cv::Scalar::all(darkest), black);
  // A rim of black joins all black areas that touch the border into one, which is then filled away.
  cv::Mat framed;
  cv::copyMakeBorder(black, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  cv::floodFill(framed, cv::Point(0, 0), cv::Scalar(128));
  return framed(cv::Rect(1, 1, black.cols, black.rows)) != 128;
}

}  // namespace roadfix
