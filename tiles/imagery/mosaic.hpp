// Rasters of one source seen as one picture of the ground on the map's plane. Where images overlap, the first one (in
// the order given) that holds something wins.
//
// Memory does not grow with the images: a window is warped in pieces of about a megapixel of source each.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/detect/road_detector.hpp"
#include "core/geodesy/utm.hpp"
#include "core/units/planar.hpp"
#include "core/units/provenance.hpp"
#include "tiles/imagery/band_notes.hpp"
#include "tiles/imagery/picture_range.hpp"
#include "tiles/imagery/position_error.hpp"
#include "tiles/imagery/raster_file.hpp"
#include "tiles/imagery/road_values.hpp"

namespace roadfix {

/// How values become 0..255 where the type does not say it.
enum class ValueRule {
  /// Bytes as they are (NBITS of each image respected), anything else from the 0.5th to the 99.5th percentile of values
  /// sampled evenly over all such images of the source, but for what fills a rim: one range for all their bands, images
  /// and blocks.
  kPicture,
  /// Shares of road: floats 0..1; bytes 0..255, or 0..1 when no value of any image is larger; wider integers 0..65535,
  /// or as bytes when no value is larger. Bytes that roadfix wrote: 0..254.
  /// Masks of 0 and 1 beside masks of 0 and 255 keep their own range.
  kShare,
};

class Mosaic {
 public:
  /// Throws what RasterFile and Georeference throw, and InvalidInput ("road-values-mixed") for shares of several types,
  /// ("imagery-mixed") for what looks like heights beside colours.
  Mosaic(const std::vector<std::string>& paths, const RasterOptions& options, ValueRule rule, UtmZone zone);
  ~Mosaic();

  GridBox extent() const { return extent_; }
  bool touches(const GridBox& box) const;
  /// Of the finest image.
  double gsd_m() const { return gsd_m_; }
  bool holds_integers() const { return integers_; }
  /// Whether roadfix wrote all of it.
  bool exported() const { return exported_; }
  /// Of the images whose type does not say it; of the first one where all types do.
  ValueRange range() const { return range_; }
  /// Of a source of shares.
  const ShareValues& share_values() const { return share_values_; }
  std::string crs() const { return crs_; }
  /// Each of the image of which it is the largest.
  const PositionErrors& position_errors() const { return position_errors_; }

  /// Of pictures: what they say, or do not say, about the meaning of their bands.
  std::vector<std::string> band_notes() const { return notes_.texts(); }

  /// What the images tell of themselves together; the registration error only where each tells its own.
  Provenance told() const;

  /// The ground in the box in pixels of `gsd_m`, north up; pixels without data are not observed, nor is what pictures
  /// show blank (exclude_blank). Thread-safe. Throws what RasterFile::read() throws.
  GroundImage view(const GridBox& box, double gsd_m) const;

 private:
  struct Image;
  struct Handle;
  void add_image(const std::string& path, ThinnedValues& values);
  void choose_ranges(std::vector<float> values);
  void find_collars();
  std::unique_ptr<Handle> borrow(std::size_t image, const GridBox& box, double gsd_m) const;
  std::shared_ptr<RasterFile> open(const Image& image, double gsd_m) const;
  void give_back(std::unique_ptr<Handle> handle) const;

  RasterOptions options_;
  ValueRule rule_;
  UtmZone zone_;
  std::vector<Image> images_;
  GridBox extent_ = kEmptyBox;
  double gsd_m_ = 0.0;
  int channels_ = 1;
  bool integers_ = false;
  bool exported_ = true;
  ValueRange range_;
  ShareValues share_values_;
  std::string crs_;
  PositionErrors position_errors_;
  std::vector<Provenance> told_;  ///< by each image
  BandNotes notes_;
  mutable std::mutex mutex_;
  mutable std::list<std::unique_ptr<Handle>> idle_;  ///< the most recently used first
  /// Of images that all threads read through one file, since each file would unpack and keep all their rows.
  mutable std::map<std::size_t, std::weak_ptr<RasterFile>> by_turns_;
};

}  // namespace roadfix
