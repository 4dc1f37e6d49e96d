// Where the lines of a network lie, as boxes.
#pragma once

#include <ogr_core.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "tiles/roads/road_lines.hpp"

namespace roadfix {

/// Around a line of the network.
GridBox box_of(const RoadNetwork& network, const RoadLine& line);
/// Around each of `lines`, which are lines of `network`.
std::vector<GridBox> boxes_of(const RoadNetwork& network, std::span<const RoadLine> lines);

/// From west to east and from south to north without the outermost on each side, one of `one_in`: so few move none of
/// its rims. At least one box.
GridBox middle_of(std::span<const GridBox> boxes, std::size_t one_in);

/// Around the box, in degrees; nullopt where it has no place on the Earth.
std::optional<OGREnvelope> box_on_earth(const GridBox& box, UtmZone zone);

/// "W,S,E,N" as --extent takes it, rounded outwards.
std::string extent_text(const OGREnvelope& degrees);

}  // namespace roadfix
