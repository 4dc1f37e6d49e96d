// One georeferenced raster as a whole, north up on the plane of a zone: for what fits into memory.
#pragma once

#include <string>

#include "core/detect/orthoimage.hpp"
#include "core/geodesy/utm.hpp"
#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

/// At its own ground sample distance. Throws what Mosaic throws and LimitExceeded ("imagery-too-large") beyond 400
/// megapixels.
Orthoimage read_orthoimage(const std::string& path, const UtmZone& zone);

/// The zone that its centre lies in. Throws what RasterFile and Georeference throw.
UtmZone zone_of_image(const std::string& path, const RasterOptions& options = {});

}  // namespace roadfix
