#include "core/detect/blank_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace roadfix {
namespace {

constexpr int kBlocks = 4;  // along a side of a square
constexpr int kMinBlockPx = 4;
constexpr int kLevels = 1;  // of rounding, where a colour was resampled or compressed

/// What was observed of each block.
struct Blocks {
  cv::Mat lowest;   ///< of the image's type, 255 where nothing was observed
  cv::Mat highest;  ///< likewise, 0 where nothing was
  cv::Mat pixels;   ///< CV_32FC1, their number
};

/// The lowest or highest values of the columns of a strip, and of these of each block: plain loops, since OpenCV takes
/// longer to begin with a block than to look at it.
void reduce_blocks(const cv::Mat& strip, int block_px, cv::ReduceTypes kind, cv::Mat blocks) {
  cv::Mat line;
  cv::reduce(strip, line, 0, kind);
  const bool lowest = kind == cv::REDUCE_MIN;
  const int channels = strip.channels();
  const auto* values = line.ptr<std::uint8_t>();
  auto* block = blocks.ptr<std::uint8_t>();
  for (int col = 0; col < line.cols; ++col) {
    for (int c = 0; c < channels; ++c) {
      const std::uint8_t value = values[col * channels + c];
      std::uint8_t& best = block[col / block_px * channels + c];
      if (col % block_px == 0 || (lowest ? value < best : value > best)) best = value;
    }
  }
}

void count_in_blocks(const cv::Mat& observed, int block_px, cv::Mat blocks) {
  cv::Mat line;
  cv::reduce(observed, line, 0, cv::REDUCE_SUM, CV_32S);
  blocks.setTo(cv::Scalar(0));
  for (int col = 0; col < line.cols; ++col) {
    const int pixels = line.at<int>(0, col) / 255;
    blocks.at<float>(0, col / block_px) += static_cast<float>(pixels);
  }
}

cv::Mat filled(const cv::Mat& pixels, const cv::Mat& unseen, double value) {
  cv::Mat result = pixels.clone();
  result.setTo(cv::Scalar::all(value), unseen);
  return result;
}

Blocks blocks_of(const GroundImage& image, int block_px) {
  const auto whole = [&](int length) { return (length + block_px - 1) / block_px; };
  const cv::Size size(whole(image.pixels.cols), whole(image.pixels.rows));
  Blocks blocks{cv::Mat(size, image.pixels.type()), cv::Mat(size, image.pixels.type()), cv::Mat(size, CV_32FC1)};
  for (int row = 0; row < size.height; ++row) {
    const cv::Range rows(row * block_px, std::min((row + 1) * block_px, image.pixels.rows));
    const cv::Mat strip = image.pixels.rowRange(rows);
    const cv::Mat unseen = image.observed.rowRange(rows) == 0;
    reduce_blocks(filled(strip, unseen, 255.0), block_px, cv::REDUCE_MIN, blocks.lowest.row(row));
    reduce_blocks(filled(strip, unseen, 0.0), block_px, cv::REDUCE_MAX, blocks.highest.row(row));
    count_in_blocks(~unseen, block_px, blocks.pixels.row(row));
  }
  return blocks;
}

/// 255 for each square, by the block that its first corner lies in, in which nothing differs.
cv::Mat blank_squares(const Blocks& blocks, int block_px) {
  const cv::Point first(0, 0);
  const cv::Mat square = cv::Mat::ones(kBlocks, kBlocks, CV_8UC1);
  cv::Mat lowest;
  cv::Mat highest;
  cv::Mat pixels;
  cv::erode(blocks.lowest, lowest, square, first);
  cv::dilate(blocks.highest, highest, square, first);
  cv::boxFilter(blocks.pixels, pixels, CV_32F, square.size(), first, false, cv::BORDER_CONSTANT);
  cv::Mat blank;
  cv::inRange(highest - lowest, cv::Scalar::all(0), cv::Scalar::all(kLevels), blank);
  const double side_px = kBlocks * block_px;
  return blank & (pixels >= 0.5 * side_px * side_px);
}

}  // namespace

void exclude_blank(GroundImage& image) { exclude_blank(image, {{}, image.observed.size()}); }

void exclude_blank(GroundImage& image, const cv::Rect& part) {
  if (part.empty()) return;
  const int block_px = std::max(kMinBlockPx, static_cast<int>(std::lround(kBlankSideM / kBlocks / image.gsd_m)));
  const cv::Point last = (part.br() - cv::Point(1, 1)) / block_px;
  const cv::Point reach(kBlocks, kBlocks);  // of squares that begin before the part or end after it, and one block more
  const cv::Point first(std::max(part.x / block_px - reach.x, 0), std::max(part.y / block_px - reach.y, 0));
  const cv::Rect whole({}, image.observed.size());
  const cv::Rect around = cv::Rect(first * block_px, (last + reach + cv::Point(1, 1)) * block_px) & whole;
  const GroundImage seen{image.pixels(around), image.observed(around), image.gsd_m};
  cv::Mat blank = blank_squares(blocks_of(seen, block_px), block_px);
  // Squares that begin beyond the part may go on beyond what was looked at.
  const cv::Point squares = last - first + cv::Point(1, 1);
  blank.colRange(std::min(squares.x, blank.cols), blank.cols).setTo(0);
  blank.rowRange(std::min(squares.y, blank.rows), blank.rows).setTo(0);
  if (cv::countNonZero(blank) == 0) return;
  // The blocks of each square and one around them.
  cv::dilate(blank, blank, cv::Mat::ones(kBlocks + 2, kBlocks + 2, CV_8UC1), {kBlocks, kBlocks});
  image.observed = image.observed.clone();
  for (int row = 0; row < blank.rows; ++row) {
    for (int col = 0; col < blank.cols; ++col) {
      if (blank.at<std::uint8_t>(row, col) == 0) continue;
      const cv::Point corner = (first + cv::Point(col, row)) * block_px;
      image.observed(cv::Rect(corner, cv::Size(block_px, block_px)) & whole).setTo(0);
    }
  }
}

}  // namespace roadfix
