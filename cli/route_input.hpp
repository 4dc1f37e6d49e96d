// The route that a command is told.
#pragma once

#include <filesystem>
#include <vector>

#include "core/geodesy/latlon.hpp"

namespace roadfix::cli {

/// Its places, two at least. Says on stderr what of a plan is left out. Throws as routes::read_route().
std::vector<LatLon> route_with_notes(const std::filesystem::path& file);

}  // namespace roadfix::cli
