#include "tiles/store/map_file.hpp"

#include <fmt/format.h>

#include <optional>
#include <system_error>

#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "core/units/shell_word.hpp"
#include "core/units/text.hpp"
#include "tiles/store/map_error.hpp"
#include "tiles/store/shift_table.hpp"
#include "tiles/store/source_table.hpp"
#include "tiles/store/terrain_table.hpp"
#include "tiles/store/tile_matrix.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;
using sqlite::Connection;
using sqlite::number;
using sqlite::Statement;
using sqlite::Transaction;

constexpr std::int64_t kGeoPackageId = 0x47504B47;

std::string meta_value(Connection& map, const char* key) {
  Statement select(map, "SELECT value FROM roadfix_meta WHERE key = ?1");
  if (select.with(key).step()) return select.text(0);
  throw CorruptData("map-corrupt",
                    fmt::format("{}: roadfix_meta has no {}. Restore the map from a copy", map.path().string(), key));
}

void require_ours(Connection& map) {
  const std::string file = map.path().string();
  if (number(map, "PRAGMA application_id") != kGeoPackageId) {
    throw InvalidInput("map-not-ours",
                       fmt::format("{}: a database, but not a GeoPackage. Name a map made by roadfix", file));
  }
  if (number(map, "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'roadfix_meta'") == 0) {
    throw InvalidInput("map-not-ours", fmt::format("{}: a GeoPackage, but not a map made by roadfix. To make a map out "
                                                   "of it, name it as a source: roadfix ingest {} --map MAP.gpkg",
                                                   file, shell_word(file)));
  }
  const auto version = as_number<int>(meta_value(map, "schema_version"));
  if (!version || *version < 1) {
    throw CorruptData("map-corrupt", fmt::format("{}: roadfix_meta names no schema version. Restore the map from a "
                                                 "copy",
                                                 file));
  }
  if (*version < kSchemaVersion) {
    throw InvalidInput("map-from-older-version",
                       fmt::format("{}: written by an older roadfix (map format {}, this program has {}). Ingest its "
                                   "sources into a new map",
                                   file, *version, kSchemaVersion));
  }
  if (*version > kSchemaVersion) {
    throw InvalidInput("map-from-newer-version",
                       fmt::format("{}: written by a newer roadfix (map format {}, this program knows up to {}). "
                                   "Update roadfix",
                                   file, *version, kSchemaVersion));
  }
}

void require_content(const fs::path& path) {
  std::error_code error;
  if (!is_there(path)) {
    const char* what = fs::is_symlink(path, error) ? "a link to a file that is not there" : "no such file";
    throw NotFound("map-not-found", fmt::format("{}: {}", path.string(), what));
  }
  if (!fs::is_regular_file(path, error)) {
    throw InvalidInput("map-not-ours", fmt::format("{}: not a file. Name a map made by roadfix", path.string()));
  }
  if (fs::file_size(path, error) == 0 && !error) {
    throw CorruptData("map-empty-file", fmt::format("{}: the file is empty (0 bytes). Remove it and ingest the sources "
                                                    "again",
                                                    path.string()));
  }
}

/// A file shorter than its header says: SQLite would only call it corrupt.
void explain_cut_off(const Connection& map) {
  const std::int64_t missing = map.missing_bytes();
  if (missing == 0) return;
  throw CorruptData("map-cut-off",
                    fmt::format("{}: the file is cut off, {} bytes are missing at its end. Copy it again "
                                "or ingest its sources into a new map",
                                map.path().string(), missing));
}

/// In WAL mode even a reader has to write files into the map's folder.
void explain_wal_mode(const Connection& map) {
  if (!map.in_wal_mode()) return;
  throw IoFailure(
      "map-in-wal-mode",
      fmt::format("{}: another program left it in SQLite's WAL mode, in which it cannot be read in a folder "
                  "that may not be written to. Close it there and run roadfix verify --repair on it where "
                  "it may be written to",
                  map.path().string()));
}

/// Reads from the file for the first time; rolls back what a killed writer left.
void look_into(Connection& map, std::chrono::milliseconds patience) {
  const Transaction no_writer_between(map, Transaction::Kind::kRead);
  constexpr const char* kLook = "SELECT count(*) FROM sqlite_master";
  try {
    number(map, kLook);
  } catch (const IoFailure& error) {
    if (error.code() != kMapNeedsRecovery) {
      explain_wal_mode(map);
      throw;
    }
    recover_map(map.path(), patience);
    number(map, kLook);
  }
  explain_cut_off(map);
}

/// QGIS leaves a map that it did not close in WAL mode, which is not readable in a folder without write permission.
void leave_wal_mode(Connection& map) {
  try {
    Statement(map, "PRAGMA journal_mode = DELETE").run();
  } catch (const InUse&) {
    // Somebody has it open. It can be written to all the same, and the next writer will try again.
  }
}

}  // namespace

bool is_there(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (fs::status_known(status) && !error) return true;
  throw IoFailure("map-io", fmt::format("{}: {}", path.string(), error.message()));
}

void recover_map(const fs::path& path, std::chrono::milliseconds patience) {
  Connection map(path, Access::kReadWrite, map_error, patience);
  number(map, "SELECT count(*) FROM sqlite_master");
}

Connection open_map(const fs::path& path, Access access, std::chrono::milliseconds patience) {
  require_content(path);
  Connection map(path, access, map_error, patience);
  try {
    look_into(map, patience);
    require_ours(map);
    if (access == Access::kReadWrite) leave_wal_mode(map);
  } catch (const CorruptData&) {
    explain_cut_off(map);
    throw;
  }
  return map;
}

MapSettings settings_as_written(Connection& map) {
  const auto epsg = as_number<int>(meta_value(map, "epsg"));
  const auto cell_m = as_number<double>(meta_value(map, "cell_m"));
  const auto zone = epsg ? UtmZone::from_epsg(*epsg) : std::nullopt;
  if (!zone || !cell_m || !is_map_cell_size(*cell_m)) {
    throw CorruptData("map-corrupt",
                      fmt::format("{}: roadfix_meta names no UTM zone and cell size that a map can have. "
                                  "Restore the map from a copy",
                                  map.path().string()));
  }
  return {*zone, *cell_m};
}

MapSettings read_settings(Connection& map) {
  const MapSettings settings = settings_as_written(map);
  if (lattice_has(map, settings)) return settings;
  throw CorruptData("map-corrupt",
                    fmt::format("{}: roadfix_meta names EPSG:{} and cells of {} m, the tables of the tile lattice "
                                "another zone or cell size: one of them is damaged, and positions would be wrong. "
                                "Restore the map from a copy",
                                map.path().string(), settings.zone.epsg(), settings.cell_m));
}

bool lattice_has(Connection& map, const MapSettings& settings) {
  Statement finest(map,
                   "SELECT s.srs_id, m.zoom_level, m.pixel_x_size, m.pixel_y_size FROM gpkg_tile_matrix_set s JOIN "
                   "gpkg_tile_matrix m ON m.table_name = s.table_name WHERE s.table_name = 'road_probability' ORDER BY "
                   "m.zoom_level DESC LIMIT 1");
  return finest.step() && finest.integer(0) == settings.zone.epsg() && finest.integer(1) == zoom_of(settings.cell_m) &&
         finest.real(2) == settings.cell_m && finest.real(3) == settings.cell_m;
}

std::string version_text(std::uint64_t version) { return fmt::format("{:016x}", version); }

std::string read_version(Connection& map) { return meta_value(map, "version"); }

GridBox read_extent(Connection& map) {
  Statement row(map,
                "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'road_probability' AND "
                "min_x IS NOT NULL");
  if (!row.step()) return kNothingObserved;
  const GridBox box{{row.real(0), row.real(1)}, {row.real(2), row.real(3)}};
  if (!box.empty() && kLattice.contains(box.min) && kLattice.contains(box.max)) return box;
  throw CorruptData("map-corrupt",
                    fmt::format("{}: gpkg_contents gives an extent that no map can have. Restore the map "
                                "from a copy",
                                map.path().string()));
}

std::int64_t count_pending(Connection& map) { return number(map, "SELECT count(*) FROM roadfix_pending"); }

MapInfo read_info(Connection& map) {
  const Transaction one_view(map, Transaction::Kind::kRead);
  MapInfo info{.settings = read_settings(map)};
  info.version = read_version(map);
  info.schema_version = *as_number<int>(meta_value(map, "schema_version"));
  info.levels = zoom_of(info.settings.cell_m) - kCoarsestZoom + 1;
  info.extent = read_extent(map);
  Statement tiles(map, "SELECT count(*) FROM road_probability WHERE zoom_level = ?1");
  tiles.with(zoom_of(info.settings.cell_m)).step();
  info.tiles = tiles.integer(0);
  info.pending = count_pending(map);
  info.error_of_removed_m = error_of_removed_m(map);
  info.sources = SourceTable(map, zoom_of(info.settings.cell_m)).all();
  info.terrain = read_terrain(map, info.extent);
  return info;
}

}  // namespace roadfix
