#include "core/detect/painted_border.hpp"

#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace roadfix {
namespace {

/// 255 where pixels of that level in each channel, or pixels that were not seen, lead to the rim.
cv::Mat border_of(const FramePixels& frame, std::uint8_t level) {
  cv::Mat like;
  cv::inRange(frame.pixels, cv::Scalar::all(level - kBorderTolerance), cv::Scalar::all(level + kBorderTolerance), like);
  return joined_to_rim(like | (frame.observed == 0));
}

}  // namespace

cv::Mat joined_to_rim(const cv::Mat& marked) {
  // A rim around it joins all areas that touch its own into one.
  cv::Mat framed;
  cv::copyMakeBorder(marked, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  constexpr std::uint8_t kReached = 128;
  cv::floodFill(framed, cv::Point(0, 0), cv::Scalar(kReached));
  return framed(cv::Rect(1, 1, marked.cols, marked.rows)) == kReached;
}

std::optional<std::uint8_t> painted_level(const cv::Mat& corner) {
  constexpr double kPure = 3.0;  // within what codecs change
  double low = 0.0;
  double high = 0.0;
  cv::minMaxIdx(corner.reshape(1), &low, &high);
  if (high <= kPure) return std::uint8_t{0};
  if (low >= 255.0 - kPure) return std::uint8_t{255};
  return std::nullopt;
}

std::vector<cv::Rect> corner_squares(cv::Size picture) {
  constexpr int kSidePx = 8;
  std::vector<cv::Rect> corners;
  if (picture.width < 2 * kSidePx || picture.height < 2 * kSidePx) return corners;
  for (const int x : {0, picture.width - kSidePx}) {
    for (const int y : {0, picture.height - kSidePx}) corners.emplace_back(x, y, kSidePx, kSidePx);
  }
  return corners;
}

void exclude_painted_border(FramePixels& frame) {
  cv::Mat observed = frame.observed.clone();
  for (const cv::Rect& corner : corner_squares(frame.pixels.size())) {
    if (cv::countNonZero(observed(corner)) < corner.area()) continue;
    if (const auto level = painted_level(frame.pixels(corner))) {
      observed &= ~border_of({frame.pixels, observed}, *level);
    }
  }
  frame.observed = observed;
}

}  // namespace roadfix
