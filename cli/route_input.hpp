// The route that a command is told.
#pragma once

#include <filesystem>

#include "core/routes/route.hpp"

namespace roadfix::cli {

/// Says on stderr what of a plan is left out. Throws as routes::read_route().
routes::Route route_with_notes(const std::filesystem::path& file);

}  // namespace roadfix::cli
