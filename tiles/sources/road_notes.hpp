// What to tell of roads that were read: those that are not drawn, and the widths of those that are. For the reader of
// road lines; not for other modules.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "tiles/sources/road_lines.hpp"

namespace roadfix {

struct LineCounts {
  std::int64_t lines = 0;
  std::int64_t impossible = 0;   ///< besides, those with coordinates of no place on Earth
  std::string first_impossible;  ///< which of the features
  std::map<std::string, std::int64_t> unknown_classes;
  std::int64_t without_class = 0;        ///< lines of layers with classes
  std::int64_t roads_without_class = 0;  ///< those of them that nothing calls a river or the like
};

/// Orders the stated widths anew.
void add_notes(const LineCounts& counts, const RoadRules& rules, RoadNetwork& network);

/// For a message about a network that is empty.
std::string why_none_is_drawn(const LineCounts& counts, const RoadNetwork& network, const RoadRules& rules);

}  // namespace roadfix
