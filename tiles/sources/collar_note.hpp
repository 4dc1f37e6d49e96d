// Ground without imagery that is painted black or white and marked by nothing: worth a word before it becomes "no
// road".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// A note that names the first of the images of which at least a fiftieth of the samples are pure black or white, or of
/// more than 8 bits and all of the lowest or highest value, and the option that helps; nullopt where none is, and where
/// the user named a colour.
/// Looks into some of many images, and into 256 windows of each.
std::optional<std::string> note_on_collar(const std::vector<std::string>& paths, const RasterOptions& options);

}  // namespace roadfix
