// A file as a map: recognised and described. Shared by reader, writer and verifier; not for other modules.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

inline constexpr int kSchemaVersion = 2;

/// SQL for the present time as GeoPackage writes it.
inline constexpr const char* kSqlNow = "strftime('%Y-%m-%dT%H:%M:%fZ','now')";

/// Throws IoFailure ("map-io") if that cannot be found out.
bool is_there(const std::filesystem::path& path);

/// Opens what create_map made. Rolls back what a killed writer left unfinished, if possible even for reading.
/// Throws NotFound ("map-not-found"), InvalidInput ("map-not-ours", "map-from-newer-version", "map-from-older-version")
/// or CorruptData ("map-empty-file", "map-cut-off", "map-corrupt"), and, as all that uses the connection, InUse
/// ("map-busy") where a writer keeps the file locked for longer than `patience`.
sqlite::Connection open_map(const std::filesystem::path& path, sqlite::Access access,
                            std::chrono::milliseconds patience = sqlite::kPatience);

/// Rolls back what a killed writer left. Throws IoFailure ("map-needs-recovery") where the file cannot be written to,
/// InUse ("map-busy").
void recover_map(const std::filesystem::path& path, std::chrono::milliseconds patience);

/// Throws CorruptData ("map-corrupt") where the tables that describe the tiles to other programs name another zone or
/// cell size: a bit that has flipped in either of them would put every position elsewhere.
MapSettings read_settings(sqlite::Connection& map);
/// Without that check, for a verifier that reports what does not fit together.
MapSettings settings_as_written(sqlite::Connection& map);
/// Whether the lattice of the tiles is in this zone and its finest cells have this size.
bool lattice_has(sqlite::Connection& map, const MapSettings& settings);
/// As roadfix_meta and MapInfo have it.
std::string version_text(std::uint64_t version);
std::string read_version(sqlite::Connection& map);
/// Of the observed cells; kNothingObserved where there is none. Throws CorruptData ("map-corrupt").
GridBox read_extent(sqlite::Connection& map);
/// Number of tiles that wait to be fused.
std::int64_t count_pending(sqlite::Connection& map);
MapInfo read_info(sqlite::Connection& map);

}  // namespace roadfix
