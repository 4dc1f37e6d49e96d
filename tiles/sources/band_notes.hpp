// What imagery says, or does not say, about the meaning of its bands.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// Whether it has one band of real numbers.
bool looks_like_heights(const RasterFile& file);
std::optional<std::string> note_on_likely_heights(const RasterFile& file);

/// Of more than three bands without colours, of bands that have some of the three, and of an alpha band that looks like
/// something else, as near infrared written without saying so does.
std::vector<std::string> notes_on_bands(RasterFile& file);

}  // namespace roadfix
