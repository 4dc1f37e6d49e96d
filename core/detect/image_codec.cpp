#include "core/detect/image_codec.hpp"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/detect/jpeg_decoder.hpp"
#include "core/detect/png_decoder.hpp"
#include "core/png/png_text.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

std::optional<ImageHeader> png_header(Bytes bytes) {
  constexpr std::size_t kHeaderEnd = 24;  // signature, chunk length and name, width, height
  if (bytes.size() < kHeaderEnd || !is_png(bytes)) return std::nullopt;
  return ImageHeader{ImageHeader::Format::kPng, big_endian(bytes.subspan(16, 4)), big_endian(bytes.subspan(20, 4))};
}

bool is_frame_header(std::uint8_t marker) {
  // SOF0..SOF15 without DHT, JPG and DAC, which share the range.
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

std::optional<ImageHeader> jpeg_header(Bytes bytes) {
  if (bytes.size() < 4 || bytes[0] != 0xff || bytes[1] != 0xd8) return std::nullopt;
  std::size_t at = 2;
  while (at + 9 <= bytes.size() && bytes[at] == 0xff) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    if (is_frame_header(marker)) {
      return ImageHeader{ImageHeader::Format::kJpeg, big_endian(bytes.subspan(at + 7, 2)),
                         big_endian(bytes.subspan(at + 5, 2))};
    }
    at += 2 + static_cast<std::size_t>(big_endian(bytes.subspan(at + 2, 2)));
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageHeader> read_image_header(Bytes bytes) {
  if (auto header = png_header(bytes)) return header;
  return jpeg_header(bytes);
}

cv::Mat decode_image(Bytes bytes, std::int64_t max_pixels, const std::stop_token& stop) {
  const auto header = read_image_header(bytes);
  if (!header) {
    throw InvalidInput("image-format",
                       "the bytes are neither a PNG nor a JPEG image: convert them (gdal_translate -of PNG)");
  }
  if (header->cols <= 0 || header->rows <= 0) throw InvalidInput("image-damaged", "the image has no pixels");
  if (header->cols > max_pixels / header->rows) {
    throw LimitExceeded("image-too-large",
                        fmt::format("the image has {} x {} pixels; at most {} pixels are allowed: send it smaller",
                                    header->cols, header->rows, max_pixels));
  }
  const cv::Size2l told(header->cols, header->rows);
  return header->format == ImageHeader::Format::kPng ? decode_png(bytes, told) : decode_jpeg(bytes, told, stop);
}

std::vector<std::uint8_t> encode_frame(const FramePixels& frame) {
  cv::Mat picture = frame.pixels;
  if (cv::countNonZero(frame.observed) != static_cast<int>(frame.observed.total())) {
    cv::cvtColor(frame.pixels, picture, frame.pixels.channels() == 1 ? cv::COLOR_GRAY2BGRA : cv::COLOR_BGR2BGRA);
    cv::insertChannel(frame.observed, picture, 3);
  }
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  return png;
}

}  // namespace roadfix
