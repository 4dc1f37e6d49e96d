// A new map file. For the writer; not for other modules.
#pragma once

#include <filesystem>

#include "tiles/store/map_records.hpp"

namespace roadfix {

/// Makes an empty map under the name, which must be free, in one step: killed at any point, there is a whole map or
/// none.
/// Throws InvalidInput ("cell-size-not-supported") or IoFailure.
void create_map(const std::filesystem::path& path, const MapSettings& settings);

}  // namespace roadfix
