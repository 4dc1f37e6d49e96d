// A real road network, from anything OGR reads, as the streets of a plan.
#pragma once

#include <string>
#include <vector>

#include "tiles/world/plan.hpp"
#include "tiles/world/settings.hpp"

namespace roadfix::world {

/// The files of a file, folder or ZIP archive of road lines, as `ingest` takes them. Throws NotFound or InvalidInput as
/// find_source() does, and InvalidInput "world-roads-are-pictures".
std::vector<std::string> road_files(const std::string& source);

/// Roads that a camera sees (rules of tiles/sources) and that touch the picture or its surroundings. Throws NotFound or
/// InvalidInput as tiles/sources does, and InvalidInput "world-without-roads" when none lies in the picture.
std::vector<Street> read_streets(const std::string& source, const Placement& placement);

}  // namespace roadfix::world
