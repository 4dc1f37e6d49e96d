// Pictures of ground: of noise, in which no corner has one colour and no area is without contrast.
#pragma once

#include <opencv2/core.hpp>

namespace roadfix::testing {

/// 8-bit levels from 20 to 230, the same at every call.
inline cv::Mat noise(cv::Size size, int type) {
  cv::Mat picture(size, type);
  cv::RNG(5).fill(picture, cv::RNG::UNIFORM, 20, 230);
  return picture;
}

}  // namespace roadfix::testing
