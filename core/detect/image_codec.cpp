#include "core/detect/image_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/detect/frame_image.hpp"
#include "core/detect/ground_scale.hpp"
#include "core/detect/jpeg_decoder.hpp"
#include "core/detect/png_decoder.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

std::int64_t big_endian(Bytes bytes) {
  std::int64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

std::optional<ImageHeader> png_header(Bytes bytes) {
  constexpr std::size_t kHeaderEnd = 24;  // signature, chunk length and name, width, height
  if (bytes.size() < kHeaderEnd || !std::ranges::equal(bytes.first(8), kPngSignature)) return std::nullopt;
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

/// A frame that was sent as a feature map would be searched for as if its brightness were road.
void refuse_coloured(const GroundImage& picture) {
  constexpr int kStillGrey = 12;
  constexpr double kStray = 0.01;
  if (picture.pixels.channels() == 1) return;
  std::vector<cv::Mat> channels;
  cv::split(picture.pixels, channels);
  const cv::Mat spread =
      cv::max(cv::max(channels[0], channels[1]), channels[2]) - cv::min(cv::min(channels[0], channels[1]), channels[2]);
  const int coloured = cv::countNonZero((spread > kStillGrey) & picture.observed);
  if (coloured <= kStray * cv::countNonZero(picture.observed)) return;
  throw InvalidInput("feature-map-coloured",
                     fmt::format("a feature map is grey, but {} pixels of this picture are coloured: if it is a frame, "
                                 "say so and give its metres per pixel or its camera",
                                 coloured));
}

}  // namespace

std::optional<ImageHeader> read_image_header(Bytes bytes) {
  if (auto header = png_header(bytes)) return header;
  return jpeg_header(bytes);
}

cv::Mat decode_image(Bytes bytes, std::int64_t max_pixels) {
  const auto header = read_image_header(bytes);
  if (!header) throw InvalidInput("image-format", "the bytes are neither a PNG nor a JPEG image");
  if (header->cols <= 0 || header->rows <= 0) throw InvalidInput("image-damaged", "the image has no pixels");
  if (header->cols > max_pixels / header->rows) {
    throw LimitExceeded("image-too-large",
                        fmt::format("the image has {} x {} pixels; at most {} pixels are allowed: send it smaller",
                                    header->cols, header->rows, max_pixels));
  }
  cv::Mat image = header->format == ImageHeader::Format::kPng ? decode_png(bytes) : decode_jpeg(bytes);
  if (image.cols != header->cols || image.rows != header->rows) {
    throw InvalidInput("image-damaged", "the image is damaged: it has two sizes");
  }
  return image;
}

CellArray decode_feature_map(Bytes bytes, std::int64_t max_pixels) {
  const GroundImage frame = frame_image(decode_image(bytes, max_pixels), 1.0);
  refuse_coloured(frame);
  const cv::Mat grey = brightness_of(frame);
  CellArray cells(grey.cols, grey.rows);
  for (int row = 0; row < grey.rows; ++row) {
    for (int col = 0; col < grey.cols; ++col) {
      if (frame.observed.at<uchar>(row, col) != 0) cells.at(col, row) = std::min(grey.at<uchar>(row, col), kRoad);
    }
  }
  return cells;
}

std::vector<std::uint8_t> encode_feature_map(const CellArray& cells) {
  constexpr int kLongestSide = 1'000'000;  // of libpng
  if (std::max(cells.cols(), cells.rows()) > kLongestSide) {
    throw LimitExceeded(
        "too-many-cells",
        fmt::format("a PNG has at most {} columns and rows, not {} x {}: ask for larger cells, a smaller "
                    "window or another format",
                    kLongestSide, cells.cols(), cells.rows()));
  }
  cv::Mat picture(cells.rows(), cells.cols(), CV_8UC4);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      const Cell cell = cells.at(col, row);
      picture.at<cv::Vec4b>(row, col) = is_observed(cell) ? cv::Vec4b(cell, cell, cell, 255) : cv::Vec4b(0, 0, 0, 0);
    }
  }
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  return png;
}

std::vector<std::uint8_t> encode_frame(const GroundImage& image) {
  cv::Mat picture = image.pixels;
  if (cv::countNonZero(image.observed) != static_cast<int>(image.observed.total())) {
    cv::cvtColor(image.pixels, picture, image.pixels.channels() == 1 ? cv::COLOR_GRAY2BGRA : cv::COLOR_BGR2BGRA);
    cv::insertChannel(image.observed, picture, 3);
  }
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  return png;
}

}  // namespace roadfix
