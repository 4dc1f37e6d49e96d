// How far off a source lies because of what places it. Rasters with a geotransform are as exact as whoever made them
// and as the datum of their reference system is known.
#pragma once

#include "tiles/imagery/georeference.hpp"
#include "tiles/sources/datum_error.hpp"

namespace roadfix {

struct PositionErrors {
  /// Of ground control points: how far they lie from where the others put them; what is usual where an error in one
  /// would not show. Of RPC without a terrain model, also beside a geotransform: what is usual. Of NITF whose corners
  /// are rounded: what that makes.
  PositionError placing;
  PositionError datum;  ///< adds to what placed the raster in its reference system
};

/// Throws as datum_error() does.
PositionErrors position_errors(const RasterFile& file, UtmZone zone);

}  // namespace roadfix
