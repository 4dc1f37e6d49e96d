#include "core/detect/painted_border.hpp"

#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace roadfix {
namespace {

/// 255 where pixels of that colour, or pixels that were not seen, lead to the rim.
cv::Mat border_of(const GroundImage& image, const cv::Scalar& colour) {
  cv::Mat like;
  cv::inRange(image.pixels, colour - cv::Scalar::all(kBorderTolerance), colour + cv::Scalar::all(kBorderTolerance),
              like);
  return joined_to_rim(like | (image.observed == 0));
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

std::optional<cv::Scalar> painted_colour(const cv::Mat& corner) {
  constexpr double kPure = 3.0;
  double low = 0.0;
  double high = 0.0;
  cv::minMaxIdx(corner.reshape(1), &low, &high);
  if (high <= kPure) return cv::Scalar::all(0);
  if (low >= 255.0 - kPure) return cv::Scalar::all(255);
  const cv::Scalar colour = cv::mean(corner);
  cv::Mat same;
  cv::inRange(corner, colour, colour, same);
  return cv::countNonZero(same) == same.size().area() ? std::optional(colour) : std::nullopt;
}

void exclude_painted_border(GroundImage& image) {
  const cv::Size size = image.pixels.size();
  if (size.width < 2 * kCornerPx || size.height < 2 * kCornerPx) return;
  cv::Mat observed = image.observed.clone();
  for (const int x : {0, size.width - kCornerPx}) {
    for (const int y : {0, size.height - kCornerPx}) {
      const cv::Rect corner(x, y, kCornerPx, kCornerPx);
      if (cv::countNonZero(observed(corner)) < corner.area()) continue;
      if (const auto colour = painted_colour(image.pixels(corner))) {
        observed &= ~border_of({image.pixels, observed, image.gsd_m}, *colour);
      }
    }
  }
  image.observed = observed;
}

}  // namespace roadfix
