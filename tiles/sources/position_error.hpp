// How far off a raster lies because of what places it. Rasters with a geotransform are as exact as whoever made them.
#pragma once

#include <string>

#include "tiles/sources/georeference.hpp"

namespace roadfix {

struct PositionError {
  double sigma_m = 0.0;  ///< of each axis; 0 where nothing tells
  std::string reason;    ///< for the user to read, with what to do about it
};

/// Of ground control points: how far they lie from where the fit to them puts them, as far as there are more of them
/// than the fit has degrees of freedom. Of RPC without a terrain model: what is usual.
PositionError position_error(const RasterFile& file, const Georeference& georeference, UtmZone zone);

}  // namespace roadfix
