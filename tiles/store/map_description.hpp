// Do the tables that describe a map say what its tiles are? Other programs read the map by them, the service the
// errors.
#pragma once

#include <vector>

#include "tiles/store/map_verifier.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

/// What to do about most problems.
inline constexpr const char* kRepair = "Repair it with roadfix verify --repair, or restore the map from a copy";

/// Of lattice, reference system, coverage, scales of the tiles and registration errors.
std::vector<MapProblem> problems_of_description(sqlite::Connection& map, const MapSettings& settings);

}  // namespace roadfix
