#include "core/detect/frame_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/detect/painted_border.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

/// 255 where seen: without the areas of pixels of at most `darkest` in each channel that touch the rim.
cv::Mat seen_inside_black_border(const cv::Mat& pixels, int darkest) {
  cv::Mat black;
  cv::inRange(pixels, cv::Scalar::all(0), cv::Scalar::all(darkest), black);
  return joined_to_rim(black) == 0;
}

/// How often each value of the seen pixels occurs, all channels together.
std::vector<std::int64_t> counted_values(const cv::Mat& pixels, const cv::Mat& observed) {
  std::vector<std::int64_t> counts(std::size_t{1} << 16);
  const int channels = pixels.channels();
  for (int row = 0; row < pixels.rows; ++row) {
    const auto* values = pixels.ptr<std::uint16_t>(row);
    const auto* seen = observed.ptr<std::uint8_t>(row);
    for (int i = 0; i < pixels.cols * channels; ++i) counts[values[i]] += seen[i / channels] != 0 ? 1 : 0;
  }
  return counts;
}

/// From the 0.5th to the 99.5th percentile, as the imagery of maps: sensors fill 10 to 14 of 16 bits, or a narrow band.
cv::Mat in_eight_bits(const cv::Mat& pixels, const cv::Mat& observed) {
  const std::vector<std::int64_t> counts = counted_values(pixels, observed);
  const std::int64_t seen = std::int64_t{cv::countNonZero(observed)} * pixels.channels();
  const auto value_above = [&](std::int64_t how_many) {
    std::size_t value = 0;
    for (std::int64_t below = counts[0]; below <= how_many && value + 1 < counts.size();) below += counts[++value];
    return static_cast<double>(value);
  };
  const double low = value_above(seen / 200);
  const double high = std::max(low + 1.0, value_above(seen - 1 - seen / 200));
  cv::Mat result;
  pixels.convertTo(result, CV_8U, 255.0 / (high - low), -255.0 * low / (high - low));
  return result;
}

}  // namespace

FramePixels frame_image(cv::Mat decoded, Border border) {
  const int channels = decoded.channels();
  const bool sixteen = decoded.depth() == CV_16U;
  if (decoded.empty() || (decoded.depth() != CV_8U && !sixteen) || (channels != 1 && channels != 3 && channels != 4)) {
    throw InvalidInput("image-shape",
                       fmt::format("A frame of {} x {} pixels with {} channels: give 8 or 16 bits of grey, "
                                   "BGR or BGR with alpha.",
                                   decoded.cols, decoded.rows, channels));
  }
  FramePixels image{decoded, cv::Mat(decoded.size(), CV_8UC1, cv::Scalar(255))};
  if (channels == 4) {
    cv::Mat alpha;
    cv::extractChannel(decoded, alpha, 3);
    image.observed = alpha > (sixteen ? 32767 : 127);
    alpha.release();
    cv::cvtColor(decoded, image.pixels, cv::COLOR_BGRA2BGR);
  }
  decoded.release();
  // Lossy codecs, which blur the rim, have 8 bits.
  constexpr int kDarkest = 4;
  if (border == Border::kBlackUnseen) image.observed &= seen_inside_black_border(image.pixels, sixteen ? 0 : kDarkest);
  if (sixteen) image.pixels = in_eight_bits(image.pixels, image.observed);
  return image;
}

}  // namespace roadfix
