// A picture as another program writes it.
#pragma once

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace roadfix::testing {

inline std::vector<std::uint8_t> encoded(const char* extension, const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

}  // namespace roadfix::testing
