// Whether the files of a Shapefile belong together, as far as their numbers of records tell.
#pragma once

#include <gdal_priv.h>

#include <string>

namespace roadfix {

/// GDAL reads no more shapes than there are records of attributes, and says nothing of the others. Throws CorruptData
/// "roads-unreadable" where an .shx and the .dbf beside it hold different numbers. Without a .dbf all shapes are read.
void require_as_many_records_as_shapes(GDALDataset& shapefile, const std::string& path);

}  // namespace roadfix
