// Whether the values of a raster can be shares of road, and whether a picture is one of roads: what is clamped or
// searched for roads in silence makes a map that lies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

/// What was looked at of the values of a source.
struct ShareValues {
  ValueRange seen{1.0, 0.0};  ///< least and largest value; low > high where none is valid, or they are colours
  bool integers = false;
  bool bytes = false;      ///< integers of 8 bits at most
  bool ones_only = false;  ///< some are 1, and none lies between 1 and the largest, which is more
};

/// `values` are the least and the largest, `range` what becomes no road and road. Throws InvalidInput
/// "road-values-out-of-range" where they go further beyond it than resampling overshoots.
void require_shares(const std::string& path, const ValueRange& values, const ValueRange& range, bool integers);

/// Notes for the user: a raster without any road, a mask without "no road", values that end far below the range, and
/// values by which another range may be meant. Throws what require_shares() throws.
std::vector<std::string> notes_on_road_values(const std::string& path, const ShareValues& values,
                                              const ValueRange& range);

/// For rasters of roads, as they are read with `range`: a note where the file is in colour, as pictures of the ground
/// are, or else where most of it is road, as if dark stood for roads.
std::optional<std::string> note_on_likely_picture(const std::string& path, const RasterOptions& options,
                                                  const ValueRange& range);

/// For rasters of roads that come from roadfix: a note where another program copied them and left out what they tell of
/// themselves.
std::optional<std::string> note_on_copied_roads(const RasterFile& file);

/// For imagery: a note where the file has one band, with a palette or without, of two values alone, or of floats within
/// 0..1.
std::optional<std::string> note_on_likely_roads(RasterFile& file);

}  // namespace roadfix
