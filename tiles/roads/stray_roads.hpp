// A few roads far from all others stretch the bounding box of a file, and all ground in it counts as seen: worth a word
// before it becomes "no road".
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/geodesy/utm.hpp"
#include "tiles/roads/road_lines.hpp"

namespace roadfix {

/// A note that names the box of all but the outermost of `lines` (a line of `network`, at most a twentieth of them) and
/// the --extent that covers it, where `ground` is more than four times as large, by 10 km2 or more; else nullopt.
std::optional<std::string> note_on_stray_roads(const RoadNetwork& network, std::span<const RoadLine> lines,
                                               const GridBox& ground, UtmZone zone);

}  // namespace roadfix
