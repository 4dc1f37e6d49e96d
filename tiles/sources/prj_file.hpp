// The .prj file that names the reference system of the file beside it.
#pragma once

#include <ogr_spatialref.h>

#include <optional>
#include <string>

namespace roadfix {

/// Of the .prj file beside `path`, in the WKT of ESRI or any other; nullopt where there is none. Throws InvalidInput
/// "crs-unknown". GDAL itself reads it beside few rasters, and of a Shapefile not in WKT 2.
std::optional<OGRSpatialReference> crs_beside(const std::string& path);

}  // namespace roadfix
