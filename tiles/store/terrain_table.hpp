// The heights of a map's ground (tables roadfix_terrain and roadfix_terrain_source, which only maps with heights have).
// Shared by reader, writer and verifier; not for other modules.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/grid/terrain.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

/// In place of what was there. Part of the caller's transaction. See MapWriter::put_terrain().
void put_terrain(sqlite::Connection& map, const Terrain& terrain, const TerrainRecord& record);
/// False where there was none. Part of the caller's transaction.
bool remove_terrain(sqlite::Connection& map);

/// All of it, nullopt where the map has none. `extent` is that of the map. Throws CorruptData ("terrain-corrupt"),
/// which names the map and the tile.
std::optional<TerrainStatus> read_terrain(sqlite::Connection& map, const GridBox& extent);

/// What is wrong with it, and where; nothing of a map without it.
std::vector<std::string> damage_of_terrain(sqlite::Connection& map);
/// Drops what damage_of_terrain() tells of, and returns that: single tiles, or everything where no height would be
/// left. Part of the caller's transaction.
std::vector<std::string> drop_damaged_terrain(sqlite::Connection& map);

}  // namespace roadfix
