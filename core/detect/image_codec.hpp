// Pictures as bytes from outside. Sizes are read from the header and checked before anything is
// decoded.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/detect/frame_image.hpp"
#include "core/units/bytes.hpp"

namespace roadfix {

/// Format and size as the header says them.
struct ImageHeader {
  enum class Format { kPng, kJpeg };
  Format format = Format::kPng;
  std::int64_t cols = 0;
  std::int64_t rows = 0;
};

/// nullopt for bytes that are neither PNG (W3C PNG 5.2, 11.2.2) nor JPEG (ITU-T T.81 B.2.2).
std::optional<ImageHeader> read_image_header(Bytes bytes);

/// The image as it is stored, whatever EXIF says of how it is to be turned: 8 or 16 bits; grey, BGR or BGR with alpha;
/// frame_image() tells what of it was seen. Throws InvalidInput ("image-format", "image-damaged"), LimitExceeded
/// ("image-too-large") and, when a stop is requested, Interrupted.
cv::Mat decode_image(Bytes bytes, std::int64_t max_pixels, const std::stop_token& stop = {});

/// A frame as PNG, of which decode_image() and frame_image() make the same again (grey as BGR where not all of it was
/// seen): what was not seen is transparent. At least one pixel.
std::vector<std::uint8_t> encode_frame(const FramePixels& frame);

}  // namespace roadfix
