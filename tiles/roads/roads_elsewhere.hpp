// Roads that all lie beside the ground that they are said to cover would make it a map of "no road".
#pragma once

#include <string>

#include "core/geodesy/utm.hpp"
#include "tiles/roads/road_lines.hpp"

namespace roadfix {

/// Throws InvalidInput "source-without-roads", which says where they lie and names `path` and `extent`, where the box
/// of no road of the network, which holds some, touches that of a polygon of its ground.
void require_roads_on_ground(const RoadNetwork& network, const std::string& path, const std::string& extent,
                             UtmZone zone);

}  // namespace roadfix
