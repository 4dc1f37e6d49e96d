// What imagery says, or does not say, about the meaning of its bands.
#pragma once

#include <string>
#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// Whether it has one band of real numbers.
bool looks_like_heights(const RasterFile& file);

/// Of a file that is given as imagery: that it looks like roads or heights; more than three bands without colours, or
/// bands that have some of the three; an alpha band that looks like something else, as near infrared written without
/// saying so does.
std::vector<std::string> notes_on_imagery(const std::string& path, const RasterOptions& options);

}  // namespace roadfix
