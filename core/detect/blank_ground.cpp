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

void reduce_blocks(const cv::Mat& strip, int block_px, cv::ReduceTypes kind, cv::Mat blocks) {
  cv::Mat line;
  cv::reduce(strip, line, 0, kind);
  for (int col = 0; col < blocks.cols; ++col) {
    const int first = col * block_px;
    cv::Mat block = blocks.col(col);
    cv::reduce(line.colRange(first, std::min(first + block_px, line.cols)), block, 1, kind);
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
    for (int col = 0; col < size.width; ++col) {
      const cv::Mat block = unseen.colRange(col * block_px, std::min((col + 1) * block_px, unseen.cols));
      blocks.pixels.at<float>(row, col) = static_cast<float>(block.size().area() - cv::countNonZero(block));
    }
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

void exclude_blank(GroundImage& image) {
  const int block_px = std::max(kMinBlockPx, static_cast<int>(std::lround(kBlankSideM / kBlocks / image.gsd_m)));
  cv::Mat blank = blank_squares(blocks_of(image, block_px), block_px);
  if (cv::countNonZero(blank) == 0) return;
  // The blocks of each square and one around them.
  cv::dilate(blank, blank, cv::Mat::ones(kBlocks + 2, kBlocks + 2, CV_8UC1), {kBlocks, kBlocks});
  image.observed = image.observed.clone();
  const cv::Rect whole({0, 0}, image.observed.size());
  for (int row = 0; row < blank.rows; ++row) {
    for (int col = 0; col < blank.cols; ++col) {
      if (blank.at<std::uint8_t>(row, col) == 0) continue;
      image.observed(cv::Rect(col * block_px, row * block_px, block_px, block_px) & whole).setTo(0);
    }
  }
}

}  // namespace roadfix
