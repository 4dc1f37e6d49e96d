#include "tiles/imagery/stored_parts.hpp"

#include <algorithm>
#include <utility>

#include "tiles/imagery/raster_windows.hpp"

namespace roadfix {

std::optional<StoredParts> stored_parts(GDALDataset& dataset, const std::vector<int>& bands) {
  const auto stored = [&](const cv::Rect& window) {
    return std::ranges::any_of(bands, [&](int band) {
      const int status = dataset.GetRasterBand(band)->GetDataCoverageStatus(
          window.x, window.y, window.width, window.height, GDAL_DATA_COVERAGE_STATUS_DATA, nullptr);
      return status != GDAL_DATA_COVERAGE_STATUS_EMPTY;
    });
  };
  std::vector<cv::Rect> parts;
  std::optional<cv::Point> left_out;
  for (const cv::Rect& window : windows_of_blocks(*dataset.GetRasterBand(bands.front()))) {
    if (!stored(window)) {
      left_out = window.tl();
    } else if (!parts.empty() && parts.back().y == window.y && parts.back().br().x == window.x) {
      parts.back() |= window;
    } else {
      parts.push_back(window);
    }
  }
  if (!left_out || parts.empty()) return std::nullopt;
  return StoredParts{std::move(parts), *left_out};
}

}  // namespace roadfix
