// The interface of road detectors: the same detector makes the global map and the live feature map.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// A picture of the ground, as if seen straight from above, with square pixels of known size.
struct GroundImage {
  cv::Mat pixels;    ///< CV_8UC3 in OpenCV's BGR order, or CV_8UC1 grey
  cv::Mat observed;  ///< CV_8UC1 of the same size: 0 = not seen (nodata, outside the frame), 255 = seen
  double gsd_m = 1.0;
};

class RoadDetector {
 public:
  virtual ~RoadDetector() = default;

  /// Road probability in cells of `cell_m`: ceil(cols * gsd / cell_m) x ceil(rows * gsd / cell_m) cells, the first at
  /// the image's first corner. A cell is unobserved where less than half of its pixels were seen. Safe to call from
  /// several threads; equal input and seed give equal cells. Throws Interrupted ("detection-interrupted") some tenths
  /// of a second after `stop` is requested.
  virtual CellArray detect(const GroundImage& image, double cell_m, std::uint64_t seed,
                           const std::stop_token& stop) const = 0;
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t seed) const {
    return detect(image, cell_m, seed, {});
  }

  /// Ground sample distance at which the detector works best; callers that resample anyway choose it.
  virtual double preferred_gsd_m() const = 0;
  /// How far beyond a cell the detector looks: blocks are read with this margin.
  virtual double halo_m() const = 0;
  /// Identifies the detector without its settings: its kind, and name and checksum of its network.
  virtual std::string name() const = 0;
  /// What changes the result beside preferred_gsd_m(), as "key=value key=value".
  virtual std::string settings() const = 0;
  /// One line for the provenance of a source: name() and all parameters that change the result. Stored in maps and
  /// feature maps, where is_same_reader() has to understand it: do not change its form.
  std::string describe() const;
};

/// Whether two results of describe() have the same name(), whatever the settings.
bool is_same_reader(std::string_view description, std::string_view other);

/// Detectors and decoders call it between pieces of work: throws Interrupted ("detection-interrupted") once a stop is
/// requested.
void require_not_interrupted(const std::stop_token& stop);

/// 255 for each cell (in the layout of RoadDetector::detect) that counts as observed by the rule above, else 0; CV_8U.
cv::Mat observed_cells(const GroundImage& image, double cell_m);

}  // namespace roadfix
