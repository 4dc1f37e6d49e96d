// PNG from outside as pixels.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

namespace roadfix {

/// Grey, BGR or BGR with alpha, of 8 bits or 16, see PngOrigin::kOutside. The caller has looked at the size, `told`, in
/// the header. Throws InvalidInput "image-damaged", before it makes room for pixels where libpng finds another size.
cv::Mat decode_png(std::span<const std::uint8_t> bytes, cv::Size2l told);

}  // namespace roadfix
