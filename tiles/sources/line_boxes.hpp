// Where the lines of a network lie, as boxes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tiles/sources/road_lines.hpp"

namespace roadfix {

/// Around each of `lines`, which are lines of `network`.
std::vector<GridBox> boxes_of(const RoadNetwork& network, std::span<const RoadLine> lines);

/// From west to east and from south to north without the outermost on each side, one of `one_in`: so few move none of
/// its rims. At least one box.
GridBox middle_of(std::span<const GridBox> boxes, std::size_t one_in);

}  // namespace roadfix
