// What imagery says, or does not say, about the meaning of its bands.
#pragma once

#include <string>
#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// Of more than three bands without colours, and of an alpha band that looks like something else, as near infrared
/// written without saying so does.
std::vector<std::string> notes_on_bands(RasterFile& file);

}  // namespace roadfix
