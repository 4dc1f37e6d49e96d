#include "tiles/sources/collar_note.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>

#include "tiles/sources/picture_range.hpp"

namespace roadfix {
namespace {

constexpr int kWindows = 16;  // along each side
constexpr int kWindowPx = 16;
constexpr double kCompressionTolerance = 3.0;  // of a lossy compression
constexpr double kWorthNoting = 0.02;
constexpr std::size_t kMaxImages = 8;

struct Shares {
  double black = 0.0;
  double white = 0.0;
};

/// Of the windows that are black or white as a whole.
Shares shares_of(RasterFile& file, const ValueRange& range) {
  const cv::Size size = file.size();
  const cv::Size part(std::min(kWindowPx, size.width), std::min(kWindowPx, size.height));
  Shares shares;
  for (int i = 0; i < kWindows * kWindows; ++i) {
    const auto x = static_cast<int>(std::int64_t{size.width - part.width} * (i % kWindows) / (kWindows - 1));
    const auto y = static_cast<int>(std::int64_t{size.height - part.height} * (i / kWindows) / (kWindows - 1));
    const RasterPixels pixels = file.read({x, y, part.width, part.height}, range);
    if (cv::countNonZero(pixels.valid) < part.area()) continue;
    double min = 0.0;
    double max = 0.0;
    cv::minMaxIdx(pixels.values.reshape(1), &min, &max);
    if (max <= kCompressionTolerance) shares.black += 1.0;
    if (min >= 255.0 - kCompressionTolerance) shares.white += 1.0;
  }
  constexpr double kAll = kWindows * kWindows;
  return {shares.black / kAll, shares.white / kAll};
}

std::optional<std::string> note_on_fill(RasterFile& file) {
  const std::optional<Fill> fill = fill_of(file.sample_values());
  if (!fill || fill->share < kWorthNoting) return std::nullopt;
  return fmt::format(
      "{}: about {:.0f} % of its values are {:g}, the {}, and nothing marks that as nodata, so it is taken as ground. "
      "If "
      "nothing was seen there, mark it (gdal_edit.py -a_nodata {:g}) and use --replace, or give --nodata-color {}",
      file.path(), 100.0 * fill->share, fill->value, fill->lowest ? "lowest" : "highest", fill->value,
      fill->lowest ? "black" : "white");
}

}  // namespace

std::optional<std::string> note_on_collar(const std::vector<std::string>& paths, const RasterOptions& options) {
  if (options.collar) return std::nullopt;
  const std::size_t step = std::max<std::size_t>(1, (paths.size() + kMaxImages - 1) / kMaxImages);
  for (std::size_t i = 0; i < paths.size(); i += step) {
    RasterFile file(paths[i], options);
    if (!file.declared_range()) {
      if (auto note = note_on_fill(file)) return note;
      continue;
    }
    const Shares shares = shares_of(file, *file.declared_range());
    const bool black = shares.black >= shares.white;
    const double share = std::max(shares.black, shares.white);
    if (share < kWorthNoting) continue;
    const char* colour = black ? "black" : "white";
    return fmt::format(
        "{}: about {:.0f} % of it is pure {}, and nothing marks that as nodata, so it is taken as ground. If nothing "
        "was seen there, give --nodata-color {}",
        paths[i], 100.0 * share, colour, colour);
  }
  return std::nullopt;
}

}  // namespace roadfix
