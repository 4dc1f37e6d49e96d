// Whether the values of a raster can be shares of road, and whether a picture is one of roads: what is clamped or
// searched for roads in silence makes a map that lies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// `sampled` are the least and the largest value, `range` what becomes no road and road. Notes for the user: a raster
/// without any road, a mask without "no road", values that end far below the range. Throws InvalidInput
/// "road-values-out-of-range" for negative values and for floats above 1.
std::vector<std::string> notes_on_road_values(const std::string& path, const ValueRange& sampled,
                                              const ValueRange& range, bool integers);

/// For rasters of roads, as they are read with `range`: a note where the file is in colour, as pictures of the ground
/// are, or else where most of it is road, as if dark stood for roads.
std::optional<std::string> note_on_likely_picture(const std::string& path, const RasterOptions& options,
                                                  const ValueRange& range);

/// For imagery: a note where the file has one band of floats within 0..1, or of two values alone.
std::optional<std::string> note_on_likely_roads(const std::string& path, const RasterOptions& options);

}  // namespace roadfix
