// One open raster: which of its bands mean what, which of its pixels hold something, and where they lie.
//
// Pixel coordinates follow GDAL: (0, 0) is the outer corner of the first pixel, (0.5, 0.5) its centre.
#pragma once

#include <cstdint>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/units/planar.hpp"
#include "tiles/imagery/alpha_scale.hpp"
#include "tiles/imagery/raster_bands.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

/// What the user says about rasters that the files do not.
struct RasterOptions {
  std::string crs;            ///< replaces that of the file; needed beside a bare world file
  std::optional<Rgb> collar;  ///< its colour, where it is declared (collar.hpp)
};

/// Values of the file that become 0 and 255; what lies beyond is clamped.
struct ValueRange {
  double low = 0.0;
  double high = 255.0;
  bool shares = false;  ///< of road: values far beyond are refused; bytes, which cannot lie there, are not checked
};

/// Pixels of a window and which of them hold something.
struct RasterPixels {
  cv::Mat values;  ///< CV_8UC3 (BGR) or CV_8UC1; of read_numbers() CV_32F
  cv::Mat valid;   ///< CV_8UC1, 0 or 255
};

/// Several threads may call read() and read_numbers() once opacity() is known, which take turns with the file; all else
/// that reads it needs take_turn() there.
class RasterFile {
 public:
  /// Throws NotFound, InvalidInput ("source-unreadable", "image-without-bands", "image-without-georeference").
  /// `overview` is the index of a reduced copy to open instead of the full image.
  RasterFile(std::string path, const RasterOptions& options, std::optional<int> overview = {});

  const std::string& path() const { return path_; }
  const OGRSpatialReference& crs() const { return crs_; }
  GDALDataset& dataset() const { return *dataset_; }
  /// The one of grey; of colours that of blue.
  GDALRasterBand& first_band() const { return *dataset_->GetRasterBand(bands_.colours.front()); }
  cv::Size size() const { return {dataset_->GetRasterXSize(), dataset_->GetRasterYSize()}; }
  /// 3 for colour and palettes, 1 for grey.
  int channels() const { return !has_palette() && bands_.colours.size() < 3 ? 1 : 3; }
  /// The range that the type declares: 0..255, less where NBITS says so; nullopt where the values must be looked at.
  std::optional<ValueRange> declared_range() const;
  bool has_palette() const { return !bands_.palette.empty(); }
  bool holds_integers() const;
  /// Number of the band that says what is transparent, 0 without.
  int alpha_band() const { return bands_.alpha; }
  /// Index of the coarsest overview whose pixels are at most `reduction` times as wide as those of the image, and which
  /// knows what of it holds nothing.
  std::optional<int> overview_for(double reduction) const;

  /// Whether rows are unpacked after all those above them (JPEG, PNG, GIF), unless they are in GDAL's cache, which each
  /// handle of the file fills anew. Other formats unpack any of their blocks by itself.
  bool unpacks_from_the_top() const;

  std::unique_lock<std::mutex> take_turn() { return std::unique_lock(turns_); }
  /// The window must lie within the image. Throws CorruptData "image-unreadable-block", and what require_shares() of
  /// road_values.hpp throws.
  RasterPixels read(cv::Rect window, const ValueRange& range);
  /// Values as the file stores them: of a palette the indices. Throws CorruptData as read().
  RasterPixels read_numbers(cv::Rect window);
  /// That of the alpha band, by samples.
  const AlphaScale& opacity();
  /// Spares the samples where another handle of the file has taken them.
  void set_opacity(const AlphaScale& opacity) { opacity_ = opacity; }
  /// Of a VRT those in which its images lie, of a file that leaves blocks of nothing out those that it holds, else one,
  /// all of it. None is empty, but there may be none.
  std::vector<cv::Rect> parts() const;
  /// Small windows spread evenly over the parts, the same at every call.
  std::vector<cv::Rect> sample_windows() const;
  /// Values of valid pixels in these windows, or else anywhere, as the file stores them: of a palette the indices.
  std::vector<float> sample_values();
  /// Of all valid pixels as the file stores them, and 0; the first above `enough` that is met.
  float largest_value(float enough);

 private:
  void find_stored_parts();
  /// By its nodata values or its opacity, which are those of all that a file leaves out.
  bool is_nothing(cv::Point pixel);
  /// Those of all blocks in which the parts lie.
  std::vector<cv::Rect> all_windows() const;
  std::vector<float> valid_values(cv::Rect window);
  cv::Mat read_alpha(cv::Rect window);
  AlphaScale sample_opacity();
  cv::Mat read_stored(cv::Rect window);
  cv::Mat read_bands(cv::Rect window, int cv_depth, GDALDataType type);
  cv::Mat read_validity(cv::Rect window, const cv::Mat& values);
  /// 255 where alpha or mask hide nothing.
  cv::Mat read_opaque(cv::Rect window);
  /// Makes 0 what is nodata, no number or in a gap.
  void clear_nothing(cv::Rect window, const cv::Mat& values, cv::Mat& valid) const;
  [[noreturn]] void fail(cv::Rect window, const std::string& reason) const;

  std::string path_;
  DatasetPtr dataset_;
  OGRSpatialReference crs_;
  RasterBands bands_;
  std::optional<AlphaScale> opacity_;            ///< as far as it is known
  std::optional<std::vector<cv::Rect>> filled_;  ///< parts in which a file with gaps holds something
  std::mutex turns_;                             ///< with the dataset, for reading
};

}  // namespace roadfix
