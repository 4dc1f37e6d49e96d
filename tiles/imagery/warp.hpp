// Resamples a raster onto a north-up window of the map's plane.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "core/detect/road_detector.hpp"
#include "tiles/imagery/collar.hpp"
#include "tiles/imagery/georeference.hpp"
#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

/// What is needed to read one raster in the map's zone.
struct PlacedRaster {
  RasterFile& file;
  const Georeference& georeference;
  const ValueRange& range;
  const Collar* collar;  ///< null without
};

/// Fills the pixels of `image` (its first corner at the north-western corner of `box`) that are not observed yet.
/// Bilinear; where the raster is finer, its pixels are averaged by a power of two first. Pixels that hold nothing
/// weigh nothing, and a result is observed when at least half of its weight was.
void warp_into(const PlacedRaster& raster, const GridBox& box, GroundImage& image);

/// A raster of numbers.
struct PlacedNumbers {
  const Georeference& georeference;
  cv::Size size;
  double gsd_m;                                ///< about
  std::function<RasterPixels(cv::Rect)> read;  ///< CV_32FC1 values of a window
};

/// Means of numbers on square pixels of the ground, as CV_32FC1.
struct GroundNumbers {
  cv::Mat sums;     ///< of values by weight
  cv::Mat weights;  ///< 0 to 1: the share of the pixel that is known
  double gsd_m;
};

/// Resamples alike and adds to each pixel what it lacks to be known wholly: of rasters that overlap the first counts,
/// and where they meet they do together.
void warp_into(const PlacedNumbers& raster, const GridBox& box, GroundNumbers& ground);

}  // namespace roadfix
