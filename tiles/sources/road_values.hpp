// Whether the values of a raster can be shares of road: what is clamped in silence makes a map that lies.
#pragma once

#include <string>
#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// `sampled` are the least and the largest value, `range` what becomes no road and road. Notes for the user: a mask
/// without "no road", values that end far below the range. Throws InvalidInput "road-values-out-of-range" for negative
/// values and for floats above 1.
std::vector<std::string> notes_on_road_values(const std::string& path, const ValueRange& sampled,
                                              const ValueRange& range, bool integers);

}  // namespace roadfix
