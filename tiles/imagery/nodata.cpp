#include "tiles/imagery/nodata.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace roadfix {
namespace {

template <typename Value>
void clear(const cv::Mat& values, const std::vector<std::optional<double>>& nodata, cv::Mat& valid) {
  const bool declared = std::ranges::any_of(nodata, [](const auto& value) { return value.has_value(); });
  if (!declared && std::is_integral_v<Value>) return;
  std::vector<std::pair<int, Value>> empty;
  bool reachable = declared;  // -9999 declared for a byte band marks nothing
  for (std::size_t i = 0; i < nodata.size(); ++i) {
    if (!nodata[i] || std::isnan(*nodata[i])) continue;
    const double value = *nodata[i];
    if (std::is_integral_v<Value> && (value < 0.0 || value > 255.0 || value != std::floor(value))) reachable = false;
    if (reachable) empty.emplace_back(static_cast<int>(i), static_cast<Value>(value));
  }
  for (int row = 0; row < values.rows; ++row) {
    for (int col = 0; col < values.cols; ++col) {
      const Value* pixel = values.ptr<Value>(row, col);
      const bool gone = reachable && !empty.empty() &&
                        std::ranges::all_of(empty, [pixel](const auto& e) { return pixel[e.first] == e.second; });
      bool number = true;
      if constexpr (!std::is_integral_v<Value>) {
        for (int c = 0; c < values.channels(); ++c) number = number && std::isfinite(pixel[c]);
      }
      if (gone || !number) valid.at<std::uint8_t>(row, col) = 0;
    }
  }
}

}  // namespace

std::optional<double> nodata_of(GDALRasterBand& band) {
  int has = FALSE;
  const double value = band.GetNoDataValue(&has);
  return has == TRUE ? std::optional(value) : std::nullopt;
}

bool hides_as_much(GDALRasterBand& overview, GDALRasterBand& band) {
  const auto masked = [](GDALRasterBand& of) { return (of.GetMaskFlags() & GMF_PER_DATASET) != 0; };
  const std::optional<double> wanted = nodata_of(band);
  const std::optional<double> own = nodata_of(overview);
  const bool same = wanted == own || (wanted && own && std::isnan(*wanted) && std::isnan(*own));
  return same && (masked(overview) || !masked(band));
}

void clear_nodata(const cv::Mat& values, const std::vector<std::optional<double>>& nodata, cv::Mat& valid) {
  if (values.depth() == CV_8U) {
    clear<std::uint8_t>(values, nodata, valid);
  } else {
    clear<float>(values, nodata, valid);
  }
}

}  // namespace roadfix
