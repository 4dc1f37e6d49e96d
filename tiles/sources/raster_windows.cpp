#include "tiles/sources/raster_windows.hpp"

#include <algorithm>
#include <cstdint>

namespace roadfix {

std::vector<cv::Rect> spread_windows(cv::Size image) {
  constexpr int kWindows = 16;
  constexpr int kWindowPx = 64;
  const auto window_px = [=](int length) { return std::min(kWindowPx, (length + kWindows - 1) / kWindows); };
  const cv::Size window(window_px(image.width), window_px(image.height));
  std::vector<cv::Rect> windows;
  for (int i = 0; i < kWindows * kWindows; ++i) {
    const auto x = static_cast<int>(std::int64_t{image.width - window.width} * (i % kWindows) / (kWindows - 1));
    const auto y = static_cast<int>(std::int64_t{image.height - window.height} * (i / kWindows) / (kWindows - 1));
    windows.emplace_back(cv::Point(x, y), window);
  }
  return windows;
}

std::vector<cv::Rect> windows_of_blocks(GDALRasterBand& band) {
  constexpr int kSidePx = 1024;
  int block_width = 1;
  int block_height = 1;
  band.GetBlockSize(&block_width, &block_height);
  const int width = block_width * std::max(1, kSidePx / block_width);
  const auto blocks = std::int64_t{kSidePx} * kSidePx / (std::int64_t{width} * block_height);
  const int height = block_height * static_cast<int>(std::max(std::int64_t{1}, blocks));
  const cv::Rect whole(0, 0, band.GetXSize(), band.GetYSize());
  std::vector<cv::Rect> windows;
  for (int row = 0; row < whole.height; row += height) {
    for (int col = 0; col < whole.width; col += width) windows.push_back(cv::Rect(col, row, width, height) & whole);
  }
  return windows;
}

}  // namespace roadfix
