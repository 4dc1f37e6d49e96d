// A plan of QGroundControl: JSON of "fileType": "Plan" (docs.qgroundcontrol.com, Plan File Format).
#pragma once

#include "core/routes/route.hpp"
#include "core/units/json_file.hpp"

namespace roadfix::routes {

bool is_mission_plan(const JsonField& document);

/// From the planned home on, over simple items, the transects of surveys and corridors, and landing patterns. Throws
/// InvalidInput "waypoints-unreadable".
Route parse_mission_plan(const JsonField& document);

}  // namespace roadfix::routes
