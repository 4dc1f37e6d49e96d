// A new map file. For the writer and the verifier; not for other modules.
#pragma once

#include <filesystem>
#include <string>

#include "tiles/store/map_records.hpp"

namespace roadfix {

/// OGC WKT 1 of a UTM zone on WGS 84 as EPSG defines it: the definition by which other programs place a map.
std::string wkt_of(const UtmZone& zone);

/// Makes an empty map under the name, which must be free, in one step: killed at any point, there is a whole map or
/// none.
/// Throws InvalidInput ("cell-size-not-supported") or IoFailure.
void create_map(const std::filesystem::path& path, const MapSettings& settings);

}  // namespace roadfix
