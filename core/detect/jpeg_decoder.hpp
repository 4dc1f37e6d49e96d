// JPEG from outside as pixels. libjpeg is used as it is, since OpenCV lets it print to standard error what is wrong,
// and fills what is missing with grey.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <stop_token>

namespace roadfix {

/// Grey or BGR of 8 bits. Bytes to no purpose between the parts of a file and unknown versions of JFIF, which some
/// cameras write, are passed over. The caller has looked at the size, `told`, in the header. Throws InvalidInput
/// "image-damaged", also where libjpeg finds another size, before it makes room for pixels, and for more than 100
/// scans, each of which goes over all pixels though it may take no more than a few bytes, and "image-format" for
/// colours of printers (CMYK); Interrupted when a stop is requested.
cv::Mat decode_jpeg(std::span<const std::uint8_t> bytes, cv::Size2l told, const std::stop_token& stop = {});

}  // namespace roadfix
