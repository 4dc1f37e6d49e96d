// The reference system of a raster's coordinates, wherever that is written.
#pragma once

#include <string>

#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

/// `told` by the user, or if that is empty what the file says, or the .prj file beside it. Coordinates are in the order
/// east, north. Throws InvalidInput ("image-without-georeference") where nothing says it, or nothing places the pixels,
/// which `told` alone does not, and ("crs-unknown").
OGRSpatialReference reference_of(GDALDataset& raster, const std::string& path, const std::string& told);

}  // namespace roadfix
