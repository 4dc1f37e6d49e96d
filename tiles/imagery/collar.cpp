#include "tiles/imagery/collar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/detect/painted_border.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix {
namespace {

constexpr int kMaxSamples = 1024;

cv::Mat like(const cv::Mat& values, Rgb colour) {
  cv::Mat result;
  if (values.channels() == 1) {
    const int grey = (299 * colour.red + 587 * colour.green + 114 * colour.blue + 500) / 1000;
    cv::inRange(values, cv::Scalar(grey - kBorderTolerance), cv::Scalar(grey + kBorderTolerance), result);
  } else {
    const cv::Scalar bgr(colour.blue, colour.green, colour.red);
    cv::inRange(values, bgr - cv::Scalar::all(kBorderTolerance), bgr + cv::Scalar::all(kBorderTolerance), result);
  }
  return result;
}

}  // namespace

Collar::Collar(RasterFile& file, Rgb colour, const ValueRange& range) : image_(file.size()), colour_(colour) {
  const cv::Size samples(std::min(kMaxSamples, image_.width), std::min(kMaxSamples, image_.height));
  cv::Mat candidates(samples, CV_8UC1);
  for (int row = 0; row < samples.height; ++row) {
    const auto y = static_cast<int>(std::int64_t{image_.height} * row / samples.height);
    const RasterPixels line = file.read({0, y, image_.width, 1}, range);
    const cv::Mat match = like(line.values, colour) | (line.valid == 0);
    for (int col = 0; col < samples.width; ++col) {
      const auto x = static_cast<int>(std::int64_t{image_.width} * col / samples.width);
      candidates.at<std::uint8_t>(row, col) = match.at<std::uint8_t>(0, x);
    }
  }
  // The rim of the collar falls between samples.
  cv::dilate(joined_to_rim(candidates), connected_, cv::Mat());
}

void Collar::clear(cv::Rect window, RasterPixels& pixels) const {
  const cv::Mat match = like(pixels.values, colour_);
  for (int row = 0; row < window.height; ++row) {
    const auto y = static_cast<int>(std::int64_t{window.y + row} * connected_.rows / image_.height);
    for (int col = 0; col < window.width; ++col) {
      if (match.at<std::uint8_t>(row, col) == 0) continue;
      const auto x = static_cast<int>(std::int64_t{window.x + col} * connected_.cols / image_.width);
      if (connected_.at<std::uint8_t>(y, x) != 0) pixels.valid.at<std::uint8_t>(row, col) = 0;
    }
  }
}

std::optional<Rgb> find_collar(RasterFile& file, const ValueRange& range) {
  for (const cv::Rect& corner : corner_squares(file.size())) {
    const RasterPixels pixels = file.read(corner, range);
    if (cv::countNonZero(pixels.valid) < corner.area()) continue;
    if (const auto level = painted_level(pixels.values)) return Rgb{*level, *level, *level};
  }
  return std::nullopt;
}

Rgb parse_colour(const std::string& text) {
  if (text == "white") return {255, 255, 255};
  if (text == "black") return {0, 0, 0};
  const auto parts = numbers_in<std::uint8_t>(text, ',').value_or(std::vector<std::uint8_t>());
  if (parts.size() != 3) {
    throw InvalidInput(
        "colour-unknown",
        fmt::format("'{}' is not a colour: write white, black or red,green,blue with 0 to 255 each", text));
  }
  return {parts[0], parts[1], parts[2]};
}

}  // namespace roadfix
