// How far off a source lies because of what places it. Rasters with a geotransform are as exact as whoever made them
// and as the datum of their reference system is known.
#pragma once

#include <string>

#include "tiles/sources/georeference.hpp"

namespace roadfix {

struct PositionError {
  double sigma_m = 0.0;  ///< of each axis; 0 where nothing tells
  std::string reason;    ///< for the user to read, with what to do about it
};

/// Of the datum of a reference system on_old_ellipsoid() around a place: what the EPSG registry states for the best way
/// to WGS 84 that can be taken there, if that is more than 2 m. 0 for reference systems that bring a way of their own,
/// and where the registry states nothing. Throws InvalidInput "datum-unknown", which names `path`, where nobody has
/// published any way around there.
PositionError datum_error(const OGRSpatialReference& reference, UtmZone zone, LatLon place, const std::string& path);

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
