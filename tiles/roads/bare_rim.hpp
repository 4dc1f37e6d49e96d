// An extract that was cut along a border leaves the corners of its bounding box bare, and all ground in it counts as
// seen: worth a word before it becomes "no road".
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tiles/roads/road_lines.hpp"

namespace roadfix {

/// A note where more than a quarter of the ground around `lines` (at least 200 lines of `network`) lies in squares of
/// 1 km without a road, from the rim on; else nullopt. The outermost roads on each side, one of 200, do not tell where
/// the rim is: those that cross it reach beyond any cut.
std::optional<std::string> note_on_bare_rim(const RoadNetwork& network, std::span<const RoadLine> lines);

}  // namespace roadfix
