// What to tell of roads that were read: those that are not drawn, and the widths of those that are. For the reader of
// road lines; not for other modules.
#pragma once

#include <string>

#include "tiles/roads/line_counts.hpp"
#include "tiles/roads/road_lines.hpp"

namespace roadfix {

/// Orders the stated widths anew.
void add_notes(const LineCounts& counts, const RoadRules& rules, RoadNetwork& network);

/// For a message about a network that is empty.
std::string why_none_is_drawn(const LineCounts& counts, const RoadNetwork& network, const RoadRules& rules);

}  // namespace roadfix
