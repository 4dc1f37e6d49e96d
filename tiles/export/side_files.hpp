// The files that GDAL and QGIS take for part of a picture by their names.
#pragma once

#include <filesystem>

namespace roadfix {

/// The file whose name, unlike that of other world files, serves every format.
std::filesystem::path common_world_file(std::filesystem::path picture);

/// What lies beside a picture that was just replaced is of the one before: overviews, masks, statistics, and where it
/// lay. The common world file is left beside formats that hold their place themselves: it may be of another picture.
void remove_side_files(const std::filesystem::path& picture);

}  // namespace roadfix
