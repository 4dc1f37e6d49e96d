// Missions as plain text: "QGC WPL <version>", then a line of twelve numbers for each item
// (mavlink.io/en/file_formats, Mission Plain-Text File Format).
#pragma once

#include <string_view>

#include "core/routes/route.hpp"

namespace roadfix::routes {

bool is_waypoint_list(std::string_view text);

/// From the first item, which is the home, on. Throws InvalidInput "waypoints-unreadable", which names the line.
Route parse_waypoint_list(std::string_view text);

}  // namespace roadfix::routes
