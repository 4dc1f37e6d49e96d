#include "tiles/imagery/road_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "core/units/error.hpp"
#include "tiles/sources/exported_roads.hpp"

namespace roadfix {
namespace {

/// 1 and `largest` alone, where `certain` is taken for a certain road.
std::string note_on_labels(const std::string& path, double largest, double certain) {
  return fmt::format(
      "{0}: its values are 1 and {1:g}, as labels are, and count as {2:.3g} and {3:.3g} % road. If {1:g} is road and 1 "
      "is not, rescale them (gdal_translate -scale 1 {1:g} 0 {4:g}); if 1 is road and {1:g} means nothing, mark that "
      "as nodata (gdal_edit.py -a_nodata {1:g}) and run this again (ingest: with --replace)",
      path, largest, 100.0 / certain, 100.0 * largest / certain, certain);
}

/// Values of one band: whether they are two alone, or probabilities.
class LikelyRoads {
 public:
  explicit LikelyRoads(bool may_be_probabilities) : probabilities_(may_be_probabilities) {}

  /// False once they are neither.
  bool agree(const cv::Mat& values, const cv::Mat& valid) {
    for (int row = 0; row < values.rows; ++row) {
      for (int col = 0; col < values.cols; ++col) {
        if (valid.at<std::uint8_t>(row, col) != 0 && !agrees(values.at<float>(row, col))) return false;
      }
    }
    return true;
  }
  bool vary() const { return low_ < high_; }
  bool are_two() const { return two_; }
  ValueRange seen() const { return {static_cast<double>(low_), static_cast<double>(high_)}; }

 private:
  bool agrees(float value) {
    probabilities_ = probabilities_ && value >= 0.0F && value <= 1.0F;
    const bool known = value == low_ || value == high_;
    two_ = two_ && (known || low_ >= high_);  // the third one ends it
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    return two_ || probabilities_;
  }

  bool probabilities_;
  bool two_ = true;
  float low_ = std::numeric_limits<float>::infinity();
  float high_ = -std::numeric_limits<float>::infinity();
};

}  // namespace

void require_shares(const std::string& path, const ValueRange& values, const ValueRange& range, bool integers) {
  constexpr double kResampling = 0.1;  // by which cubic resampling overshoots
  if (values.low >= -kResampling * range.high && values.high <= (1.0 + kResampling) * range.high) return;
  throw InvalidInput(
      "road-values-out-of-range",
      fmt::format("{}: its values go from {:g} to {:g}, but a raster of roads holds {} from 0 to {:g}. Mark values "
                  "that mean nothing as nodata (gdal_edit.py -a_nodata), rescale others (gdal_translate -scale)",
                  path, values.low, values.high, integers ? "integers" : "probabilities", range.high));
}

std::vector<std::string> notes_on_road_values(const std::string& path, const ShareValues& values,
                                              const ValueRange& range) {
  const double low = values.seen.low;
  const double high = values.seen.high;
  if (low > high) return {};
  require_shares(path, values.seen, range, values.integers);
  if (values.ones_only && low == 1.0) return {note_on_labels(path, high, range.high)};
  constexpr double kHalf = 0.5;
  std::vector<std::string> notes;
  if (low > kHalf * range.high) {
    notes.push_back(fmt::format(
        "{}: every pixel with data is road, so that nothing is known to be no road, and places look alike. If nodata "
        "stands for no road here, take the mark away (gdal_edit.py -unsetnodata) and run this again (ingest: with "
        "--replace)",
        path));
  }
  if (high <= 0.0) {
    notes.push_back(fmt::format(
        "{}: every value that was looked at is 0, so that all of its ground becomes no road. If it should hold roads, "
        "look at its values (gdalinfo -stats), and give the right ones (ingest: with --replace)",
        path));
  }
  if (values.integers && high > 0.0 && high < kHalf * range.high) {
    notes.push_back(fmt::format(
        "{}: its largest value is {:g} of {:g}, so that no road is surer than {:.0f} %. If it stands for certain, "
        "rescale it (gdal_translate -scale 0 {:g} 0 {:g})",
        path, high, range.high, 100.0 * high / range.high, high, range.high));
  }
  constexpr double kByte = 255.0;
  if (values.integers && !values.bytes && high > 1.0 && high < kByte) {
    notes.push_back(fmt::format(
        "{}: its integers of more than 8 bits go to {:g} only, and 255 is taken for a certain road. If 65535 is one, "
        "make bytes of them (gdal_translate -ot Byte -scale 0 65535 0 255) and run this again (ingest: with --replace)",
        path, high));
  }
  if (values.ones_only) {
    notes.push_back(
        fmt::format("{0}: its values are 0 and 1, but for some of {1:g}, so that 1 counts as {2:.2g} % road. If 1 is "
                    "road and {1:g} means nothing, mark that as nodata (gdal_edit.py -a_nodata {1:g}) and run this "
                    "again (ingest: with --replace)",
                    path, high, 100.0 / range.high));
  }
  return notes;
}

std::optional<std::string> note_on_likely_picture(const std::string& path, const RasterOptions& options,
                                                  const ValueRange& range) {
  constexpr double kStray = 0.01;
  constexpr double kStillGrey = 12.0;
  RasterFile file(path, options);
  int seen = 0;
  int coloured = 0;
  int bright = 0;
  for (const cv::Rect& window : file.sample_windows()) {
    const RasterPixels pixels = file.read(window, range);
    cv::Mat grey = pixels.values;
    if (grey.channels() == 3) {
      std::array<cv::Mat, 3> bands;
      cv::split(pixels.values, bands.data());
      const cv::Mat max = cv::max(cv::max(bands[0], bands[1]), bands[2]);
      const cv::Mat min = cv::min(cv::min(bands[0], bands[1]), bands[2]);
      coloured += cv::countNonZero((max - min > kStillGrey) & pixels.valid);
      cv::cvtColor(pixels.values, grey, cv::COLOR_BGR2GRAY);
    }
    seen += cv::countNonZero(pixels.valid);
    bright += cv::countNonZero((grey > 127) & pixels.valid);
  }
  if (coloured > kStray * seen) {
    return fmt::format(
        "{}: it is in colour, and its brightness is taken for the probability of road. If it shows the ground rather "
        "than roads, ingest it without --as roads (and --replace this source); if colours stand for roads, make a mask "
        "of 0 and 255 of it",
        path);
  }
  if (2 * bright <= seen || bright == seen) return std::nullopt;
  const double max = file.channels() == 3 ? 255.0 : range.high;
  return fmt::format(
      "{}: {:.0f} % of it is road. If dark stands for roads here, turn its values round (gdal_translate -scale 0 {:g} "
      "{:g} 0, with -expand gray where it has a palette) and run this again (ingest: with --replace)",
      path, 100.0 * bright / seen, max, max);
}

std::optional<std::string> note_on_copied_roads(const RasterFile& file) {
  if (!is_bare_copy_of_roads(file.dataset())) return std::nullopt;
  return fmt::format(
      "{}: another program copied it from a map, without its date and licence and how uncertain its position is. "
      "Ingest the map itself, or what roadfix export makes of it; or give --registration-sigma",
      file.path());
}

std::optional<std::string> note_on_likely_roads(RasterFile& file) {
  if (file.channels() != 1 && !file.has_palette()) return std::nullopt;
  LikelyRoads likely(!file.holds_integers());
  for (const cv::Rect& window : file.sample_windows()) {
    const auto [values, valid] = file.read_numbers(window);
    if (!likely.agree(values, valid)) return std::nullopt;
  }
  if (!likely.vary()) return std::nullopt;
  const ValueRange seen = likely.seen();
  return fmt::format(
      "{}: its values are {:g} {} {:g}, as those of {}. If it shows roads rather than the ground, it is no imagery "
      "(ingest: give --as roads)",
      file.path(), seen.low, likely.are_two() ? "and" : "to", seen.high,
      likely.are_two() ? "a mask of roads are" : "probabilities are");
}

}  // namespace roadfix
