// Which bands of a raster mean what, as its file says.
#pragma once

#include <gdal_priv.h>

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace roadfix {

struct RasterBands {
  std::vector<int> colours;                          ///< numbers, one of grey, or three in the order blue, green, red
  std::vector<std::optional<double>> nodata;         ///< of each of them
  std::vector<std::array<std::uint8_t, 4>> palette;  ///< blue, green, red, opacity; empty without palette
  int alpha = 0;                                     ///< number of what says what is transparent, 0 without
  bool has_mask = false;                             ///< of the dataset, that is no alpha band
  bool signed_bytes = false;                         ///< in the type of unsigned ones
};

/// Of a dataset that has a band.
RasterBands bands_of(GDALDataset& dataset);

/// The colours of a palette's indices, CV_8UC3; those of an index beyond it are black. Makes 0 in `valid` what is
/// mostly transparent.
cv::Mat colours_of(const cv::Mat& indices, const RasterBands& bands, cv::Mat& valid);

}  // namespace roadfix
