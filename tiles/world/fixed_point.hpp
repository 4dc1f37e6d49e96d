#pragma once

#include <cmath>
#include <opencv2/core.hpp>

namespace roadfix::world {

/// Bits below the pixel in the `shift` of OpenCV's drawing functions.
inline constexpr int kFraction = 4;

/// A point in pixels, with whole numbers at their centres, as these functions take it.
inline cv::Point fixed_point(cv::Point2d pixels) {
  constexpr double kUnit = 1 << kFraction;
  return {static_cast<int>(std::lround(pixels.x * kUnit)), static_cast<int>(std::lround(pixels.y * kUnit))};
}

}  // namespace roadfix::world
