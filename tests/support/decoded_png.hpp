// A picture as another program than ours reads it.
#pragma once

#include <cstddef>
#include <opencv2/imgcodecs.hpp>
#include <span>

namespace roadfix::testing {

/// Channels as OpenCV orders them.
inline cv::Mat decoded_png(std::span<const std::byte> png) {
  const cv::Mat bytes(1, static_cast<int>(png.size()), CV_8U, const_cast<std::byte*>(png.data()));
  return cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
}

}  // namespace roadfix::testing
