#include "tiles/imagery/raster_windows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace roadfix {
namespace {

constexpr int kMostAcross = 16;
constexpr int kWindows = kMostAcross * kMostAcross;

/// cv::Rect counts it as an int, which a country in a VRT exceeds.
double area_of(const cv::Rect& part) { return static_cast<double>(part.width) * part.height; }

/// As many of them each way, from edge to edge; a single one in the middle.
void add_windows(const cv::Rect& part, int across, std::vector<cv::Rect>& windows) {
  constexpr int kWindowPx = 64;
  const auto window_px = [=](int length) { return std::min(kWindowPx, (length + across - 1) / across); };
  const auto corner = [=](int room, int index) {
    return across == 1 ? room / 2 : static_cast<int>(std::int64_t{room} * index / (across - 1));
  };
  const cv::Size window(window_px(part.width), window_px(part.height));
  for (int i = 0; i < across * across; ++i) {
    const cv::Point at(corner(part.width - window.width, i % across), corner(part.height - window.height, i / across));
    windows.emplace_back(part.tl() + at, window);
  }
}

}  // namespace

std::vector<cv::Rect> spread_windows(const std::vector<cv::Rect>& parts) {
  double area = 0.0;
  for (const cv::Rect& part : parts) area += area_of(part);
  std::vector<cv::Rect> windows;
  const std::size_t step = (parts.size() + kWindows - 1) / kWindows;
  for (std::size_t i = 0; i < parts.size(); i += step) {
    const double share = static_cast<double>(step) * area_of(parts[i]) / area;
    const auto side = static_cast<int>(std::lround(std::sqrt(share * kWindows)));
    add_windows(parts[i], std::clamp(side, 1, kMostAcross), windows);
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
