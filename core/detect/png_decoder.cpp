#include "core/detect/png_decoder.hpp"

#include <fmt/format.h>

#include "core/png/png_reader.hpp"
#include "core/units/error.hpp"

namespace roadfix {

cv::Mat decode_png(std::span<const std::uint8_t> bytes, cv::Size2l told) {
  try {
    PngReader png(std::as_bytes(bytes), PngOrigin::kOutside);
    const PngShape& shape = png.shape();
    if (told != cv::Size2l(shape.cols, shape.rows)) throw CorruptData("png-damaged", "it has two sizes");
    cv::Mat pixels(shape.rows, shape.cols, CV_MAKETYPE(shape.bits == 16 ? CV_16U : CV_8U, shape.channels));
    png.read({pixels.data, shape.bytes()});
    return pixels;
  } catch (const CorruptData& error) {
    throw InvalidInput("image-damaged", fmt::format("the PNG image is damaged or cut off ({})", error.what()));
  }
}

}  // namespace roadfix
