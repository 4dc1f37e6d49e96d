// Resamples a raster onto a north-up window of the map's plane.
#pragma once

#include "core/detect/road_detector.hpp"
#include "tiles/sources/collar.hpp"
#include "tiles/sources/georeference.hpp"
#include "tiles/sources/raster_file.hpp"

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

}  // namespace roadfix
