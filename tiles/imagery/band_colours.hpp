// Which bands of a raster are blue, green and red, as far as it says so.
#pragma once

#include <gdal_priv.h>

#include <array>

namespace roadfix {

/// Numbers of the bands that are blue, green and red, 0 for none: by their colour interpretation, or where that does
/// not name all three by their descriptions, if these do ("Red").
std::array<int, 3> colour_bands(GDALDataset& dataset);

}  // namespace roadfix
