// The file that GDAL keeps beside an image for what the image's own format has no place for.
#pragma once

#include <string>

namespace roadfix {

bool is_aux_xml(const std::string& path);

/// What the file says of the image besides what its pixels and its own tags say. Programs that only look at an image
/// write the statistics of its pixels there, as QGIS does. Empty where nothing else is said, and of a damaged file,
/// which GDAL takes nothing from.
std::string told_by_aux_xml(const std::string& path);

}  // namespace roadfix
