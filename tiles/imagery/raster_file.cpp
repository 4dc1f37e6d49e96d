#include "tiles/imagery/raster_file.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/units/error.hpp"
#include "tiles/imagery/nodata.hpp"
#include "tiles/imagery/picture_range.hpp"
#include "tiles/imagery/raster_reference.hpp"
#include "tiles/imagery/raster_windows.hpp"
#include "tiles/imagery/road_values.hpp"
#include "tiles/imagery/stored_parts.hpp"
#include "tiles/imagery/vrt_parts.hpp"

namespace roadfix {
namespace {

DatasetPtr open_raster(const std::string& path, std::optional<int> overview) {
  CPLStringList options;
  if (overview) options.SetNameValue("OVERVIEW_LEVEL", fmt::format("{}", *overview).c_str());
  return open_dataset(path, GDAL_OF_RASTER, options.List());
}

/// Least and largest of the valid values and 0.
ValueRange extremes(const cv::Mat& values, const cv::Mat& valid) {
  ValueRange range;
  cv::Mat seen = values.clone();
  seen.setTo(cv::Scalar::all(0.0), valid == 0);
  cv::minMaxLoc(seen.reshape(1), &range.low, &range.high);
  return range;
}

}  // namespace

RasterFile::RasterFile(std::string path, const RasterOptions& options, std::optional<int> overview)
    : path_(std::move(path)), dataset_(open_raster(path_, overview)) {
  if (size().width <= 0 || size().height <= 0 || dataset_->GetRasterCount() == 0) {
    throw InvalidInput("image-without-bands",
                       fmt::format("{}: holds no pixels; if it is a container of images, name one "
                                   "of its subdatasets (gdalinfo lists them)",
                                   path_));
  }
  bands_ = bands_of(*dataset_);
  filled_ = filled_parts(*dataset_, bands_.colours.front());
  if (!filled_) find_stored_parts();
  crs_ = reference_of(*dataset_, path_, options.crs);
}

void RasterFile::find_stored_parts() {
  std::vector<int> bands = bands_.colours;
  if (bands_.alpha > 0) bands.push_back(bands_.alpha);
  std::optional<StoredParts> stored = stored_parts(*dataset_, bands);
  if (stored && is_nothing(stored->left_out)) filled_ = std::move(stored->parts);
}

bool RasterFile::is_nothing(cv::Point pixel) {
  const cv::Rect window(pixel, cv::Size(1, 1));
  if (bands_.alpha > 0) return cv::countNonZero(read_alpha(window)) == 0;
  cv::Mat valid(window.size(), CV_8UC1, cv::Scalar(255));
  clear_nodata(read_stored(window), bands_.nodata, valid);
  return cv::countNonZero(valid) == 0;
}

std::optional<ValueRange> RasterFile::declared_range() const {
  GDALRasterBand& band = first_band();
  if (band.GetRasterDataType() != GDT_Byte || bands_.signed_bytes) return std::nullopt;
  const char* bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const int count = bits != nullptr ? std::clamp(std::atoi(bits), 1, 8) : 8;
  return ValueRange{0.0, static_cast<double>((1 << count) - 1)};
}

bool RasterFile::holds_integers() const { return GDALDataTypeIsInteger(first_band().GetRasterDataType()) != 0; }

std::optional<int> RasterFile::overview_for(double reduction) const {
  if (bands_.signed_bytes) return std::nullopt;  // overviews do not tell that theirs are
  GDALRasterBand& band = first_band();
  std::optional<int> best;
  double best_factor = 1.0;
  for (int i = 0; i < band.GetOverviewCount(); ++i) {
    GDALRasterBand* overview = band.GetOverview(i);
    if (overview == nullptr || overview->GetXSize() <= 0 || !hides_as_much(*overview, band)) continue;
    const double factor = static_cast<double>(size().width) / overview->GetXSize();
    if (factor > best_factor && factor <= reduction * 1.01) {
      best = i;
      best_factor = factor;
    }
  }
  return best;
}

bool RasterFile::unpacks_from_the_top() const {
  constexpr std::array kDrivers{"JPEG", "PNG", "GIF"};
  const char* driver = dataset_->GetDriverName();
  return std::ranges::any_of(kDrivers, [&](const char* name) { return EQUAL(driver, name); });
}

RasterPixels RasterFile::read(cv::Rect window, const ValueRange& range) {
  RasterPixels result{{}, read_opaque(window)};
  if (cv::countNonZero(result.valid) == 0) {  // what a collar holds is not unpacked
    result.values = cv::Mat::zeros(window.size(), CV_8UC(channels()));
    return result;
  }
  const bool bytes = declared_range().has_value();
  const cv::Mat raw = read_stored(window);
  clear_nothing(window, raw, result.valid);
  if (range.shares && !bytes && !has_palette()) {
    require_shares(path_, extremes(raw, result.valid), range, holds_integers());
  }
  if (has_palette()) {
    result.values = colours_of(raw, bands_, result.valid);
  } else if (bytes && range.low == 0.0 && range.high == 255.0) {
    result.values = raw;
  } else {
    const double scale = 255.0 / (range.high - range.low);
    raw.convertTo(result.values, CV_8U, scale, -range.low * scale);
  }
  return result;
}

RasterPixels RasterFile::read_numbers(cv::Rect window) {
  const cv::Mat numbers = read_bands(window, CV_32F, GDT_Float32);
  return {numbers, read_validity(window, numbers)};
}

cv::Mat RasterFile::read_stored(cv::Rect window) {
  return declared_range() ? read_bands(window, CV_8U, GDT_Byte) : read_bands(window, CV_32F, GDT_Float32);
}

cv::Mat RasterFile::read_bands(cv::Rect window, int cv_depth, GDALDataType type) {
  const auto turn = take_turn();
  const GdalMessages messages;
  const auto channels = static_cast<int>(bands_.colours.size());
  cv::Mat pixels(window.size(), CV_MAKETYPE(cv_depth, channels));
  const auto value_bytes = static_cast<GSpacing>(pixels.elemSize1());
  const CPLErr outcome =
      dataset_->RasterIO(GF_Read, window.x, window.y, window.width, window.height, pixels.data, window.width,
                         window.height, type, channels, bands_.colours.data(), value_bytes * channels,
                         static_cast<GSpacing>(pixels.step), value_bytes, nullptr);
  if (outcome != CE_None) fail(window, messages.text());
  if (bands_.signed_bytes) {
    cv::Mat values = pixels.reshape(1);
    cv::subtract(values, cv::Scalar(256.0), values, values >= 128.0);
  }
  return pixels;
}

cv::Mat RasterFile::read_alpha(cv::Rect window) {
  const auto turn = take_turn();
  GDALRasterBand* mask = bands_.alpha > 0 ? dataset_->GetRasterBand(bands_.alpha) : first_band().GetMaskBand();
  const GdalMessages messages;
  cv::Mat alpha(window.size(), CV_32FC1);
  if (mask->RasterIO(GF_Read, window.x, window.y, window.width, window.height, alpha.data, window.width, window.height,
                     GDT_Float32, 0, static_cast<GSpacing>(alpha.step), nullptr) != CE_None) {
    fail(window, messages.text());
  }
  return alpha;
}

const AlphaScale& RasterFile::opacity() {
  if (!opacity_) opacity_ = bands_.alpha > 0 ? sample_opacity() : AlphaScale{};
  return *opacity_;
}

AlphaScale RasterFile::sample_opacity() {
  constexpr std::size_t kStep = 5;  // which leads through all rows and columns of them
  const std::vector<cv::Rect> windows = sample_windows();
  std::vector<float> samples;
  const auto add = [&](const cv::Rect& window) {
    const cv::Mat alpha = read_alpha(window);
    samples.insert(samples.end(), alpha.begin<float>(), alpha.end<float>());
  };
  for (std::size_t i = 0; i < windows.size(); i += kStep) add(windows[i]);
  if (std::ranges::all_of(samples, [](float value) { return value == 0.0F; })) std::ranges::for_each(windows, add);
  return alpha_scale(samples, dataset_->GetRasterBand(bands_.alpha)->GetRasterDataType());
}

cv::Mat RasterFile::read_opaque(cv::Rect window) {
  if (bands_.alpha > 0 || bands_.has_mask) return read_alpha(window) >= 0.5 * opacity().full;
  return {window.size(), CV_8UC1, cv::Scalar(255)};
}

void RasterFile::clear_nothing(cv::Rect window, const cv::Mat& values, cv::Mat& valid) const {
  clear_nodata(values, bands_.nodata, valid);
  if (filled_) clear_beside(*filled_, window, valid);
}

cv::Mat RasterFile::read_validity(cv::Rect window, const cv::Mat& values) {
  cv::Mat valid = read_opaque(window);
  clear_nothing(window, values, valid);
  return valid;
}

std::vector<cv::Rect> RasterFile::parts() const {
  const cv::Rect whole({}, size());
  if (!filled_) return {whole};
  std::vector<cv::Rect> parts;
  for (const cv::Rect& part : *filled_) {
    const cv::Rect within = part & whole;
    if (!within.empty()) parts.push_back(within);
  }
  return parts;
}

std::vector<cv::Rect> RasterFile::sample_windows() const { return spread_windows(parts()); }

std::vector<cv::Rect> RasterFile::all_windows() const {
  std::vector<cv::Rect> windows = windows_of_blocks(first_band());
  const std::vector<cv::Rect> held = parts();
  std::erase_if(windows, [&](const cv::Rect& window) {
    return std::ranges::none_of(held, [&](const cv::Rect& part) { return !(part & window).empty(); });
  });
  return windows;
}

std::vector<float> RasterFile::valid_values(cv::Rect window) {
  std::vector<float> values;
  const auto [raw, valid] = read_numbers(window);
  for (int row = 0; row < raw.rows; ++row) {
    for (int col = 0; col < raw.cols; ++col) {
      if (valid.at<std::uint8_t>(row, col) == 0) continue;
      const float* pixel = raw.ptr<float>(row, col);
      values.insert(values.end(), pixel, pixel + raw.channels());
    }
  }
  return values;
}

std::vector<float> RasterFile::sample_values() {
  constexpr std::size_t kMost = std::size_t{1} << 23U;
  ThinnedValues values(kMost);
  for (const cv::Rect& window : sample_windows()) values.add(valid_values(window));
  if (values.empty()) {  // a town in a large frame may lie between them
    for (const cv::Rect& window : all_windows()) values.add(valid_values(window));
  }
  return std::move(values).take();
}

float RasterFile::largest_value(float enough) {
  float largest = 0.0F;
  for (const cv::Rect& window : all_windows()) {
    const cv::Mat raw = read_stored(window);
    largest = std::max(largest, static_cast<float>(extremes(raw, read_validity(window, raw)).high));
    if (largest > enough) break;
  }
  return largest;
}

void RasterFile::fail(cv::Rect window, const std::string& reason) const {
  throw CorruptData("image-unreadable-block",
                    fmt::format("{}: the pixels at column {} row {} ({} x {}) cannot be read ({}); {}", path_, window.x,
                                window.y, window.width, window.height, reason, remedy_of_pixels(reason)));
}

}  // namespace roadfix
