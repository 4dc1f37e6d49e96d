// PNG from outside as pixels. libpng is used as it is, since OpenCV lets it print to standard error what is wrong.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

namespace roadfix {

/// Grey, BGR or BGR with alpha, of 8 bits or 16; palettes are looked up, and a colour that stands for nothing (tRNS) is
/// transparent. What stands beside the pixels is passed over: a kilobyte of text may unpack to megabytes. The caller
/// has looked at the size in the header. Throws InvalidInput "image-damaged".
cv::Mat decode_png(std::span<const std::uint8_t> bytes);

}  // namespace roadfix
