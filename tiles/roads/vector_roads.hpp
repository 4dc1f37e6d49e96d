// Road lines as a source of a map: drawn with their width, block by block.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tiles/roads/road_lines.hpp"
#include "tiles/roads/road_rules.hpp"
#include "tiles/sources/cell_source.hpp"

namespace roadfix {

/// Cells whose centre the source covers are observed: `Certainty` of the share that a road covers. Reads all lines into
/// memory at once. Throws what read_road_network throws, and InvalidInput "source-without-roads" where all roads lie
/// beside the stated extent.
std::unique_ptr<CellSource> open_road_vectors(const std::vector<std::string>& paths, const VectorOptions& options,
                                              const RoadRules& rules, UtmZone zone, double cell_m);

}  // namespace roadfix
