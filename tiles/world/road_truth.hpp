// The streets of a world as GeoJSON, to be ingested like any road data.
#pragma once

#include <string>
#include <vector>

#include "tiles/world/plan.hpp"
#include "tiles/world/settings.hpp"

namespace roadfix::world {

/// Centre lines in longitude and latitude (EPSG:4326) with `highway` and `width_m`, cut at the picture's rim. Returns
/// the number of lines. Throws IoFailure "result-unwritable".
int write_road_truth(const std::string& path, const std::vector<Street>& streets, const Placement& placement);

/// The parts of the line inside [0, width] x [0, height].
std::vector<Polyline> clipped(const Polyline& line, double width_m, double height_m);

}  // namespace roadfix::world
