#include "tiles/store/terrain_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "schema/schema.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/tile_matrix.hpp"
#include "tiles/store/tile_png.hpp"

namespace roadfix {
namespace {

using sqlite::Connection;
using sqlite::Statement;

constexpr const char* kCorrupt = "terrain-corrupt";

struct Damage {
  std::int64_t tile = 0;  ///< row of roadfix_terrain that cannot be used; 0 where none can
  std::string what;
};

struct Contents {
  Terrain terrain = {};
  std::vector<Damage> damage = {};
};

bool has_terrain(Connection& map) {
  return sqlite::number(map, "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'roadfix_terrain'") >
         0;
}

bool is_terrain_cell_size(double cell_m) {
  int exponent = 0;
  return cell_m >= Terrain::kFinestCellM && cell_m <= cell_of_zoom(0) && std::frexp(cell_m, &exponent) == 0.5;
}

std::size_t place_in(const GridGeometry& geometry, LatticeIndex cell) {
  return static_cast<std::size_t>(cell.row - geometry.origin.row) * static_cast<std::size_t>(geometry.cols) +
         static_cast<std::size_t>(cell.col - geometry.origin.col);
}

/// Copies the codes of the cells that both geometries have.
void copy_common(std::span<const std::uint16_t> from, const GridGeometry& from_geometry, std::span<std::uint16_t> to,
                 const GridGeometry& to_geometry) {
  const auto common = from_geometry.intersection(to_geometry);
  if (!common) return;
  for (int row = common->origin.row; row < common->origin.row + common->rows; ++row) {
    const LatticeIndex first{common->origin.col, row};
    std::ranges::copy(from.subspan(place_in(from_geometry, first), static_cast<std::size_t>(common->cols)),
                      to.subspan(place_in(to_geometry, first)).begin());
  }
}

bool is_known(std::uint16_t code) { return code != Terrain::kUnknown; }

/// nullopt where none is known.
std::optional<HeightRange> heights_of(const Terrain& terrain) {
  std::uint16_t lowest = Terrain::kUnknown;
  int highest = -1;
  for (const std::uint16_t code : terrain.codes) {
    if (!is_known(code)) continue;
    lowest = std::min(lowest, code);
    highest = std::max(highest, int{code});
  }
  if (highest < 0) return std::nullopt;
  return HeightRange{Terrain::kLowestM + Terrain::kStepM * lowest, Terrain::kLowestM + Terrain::kStepM * highest};
}

/// Of the cells that the extent touches.
double known_share(const Terrain& terrain, const GridBox& extent) {
  if (extent.empty()) return 0.0;
  const GridGeometry ground = GridGeometry::covering(extent, terrain.geometry.cell_m);
  const auto common = terrain.geometry.intersection(ground);
  if (!common) return 0.0;
  std::int64_t known = 0;
  for (int row = 0; row < common->rows; ++row) {
    const std::size_t first = place_in(terrain.geometry, {common->origin.col, common->origin.row + row});
    known += std::ranges::count_if(std::span(terrain.codes).subspan(first, static_cast<std::size_t>(common->cols)),
                                   is_known);
  }
  return static_cast<double>(known) / (static_cast<double>(ground.cols) * ground.rows);
}

CorruptData corrupt(const Connection& map, const std::string& what) {
  return {kCorrupt,
          fmt::format("{}: {}. Write its terrain anew with roadfix terrain, or take it out with roadfix terrain "
                      "--remove",
                      map.path().string(), what)};
}

/// nullopt where no map can have such cells: hostile ones would fill the memory.
std::optional<GridGeometry> read_geometry(Connection& map) {
  Statement row(map, "SELECT cell_m, min_x, min_y, max_x, max_y FROM roadfix_terrain_source");
  if (row.step() && is_terrain_cell_size(row.real(0))) {
    const GridBox box{{row.real(1), row.real(2)}, {row.real(3), row.real(4)}};
    if (kLattice.contains(box.min) && kLattice.contains(box.max) && !box.empty()) {
      const GridGeometry geometry = GridGeometry::covering(box, row.real(0));
      const bool whole_cells = geometry.box().min == box.min && geometry.box().max == box.max;
      if (whole_cells && std::int64_t{geometry.cols} * geometry.rows <= kMostTerrainCells) return geometry;
    }
  }
  return std::nullopt;
}

/// Throws CorruptData, which says how the tile is damaged.
void paste_tile(std::int64_t column, std::int64_t row, std::span<const std::byte> png, Terrain& terrain) {
  const GridGeometry& geometry = terrain.geometry;
  const int zoom = zoom_of(geometry.cell_m);
  if (!in_matrix(zoom, row, column)) throw CorruptData(kCorrupt, "they lie outside the lattice");
  const GridGeometry tile =
      tile_geometry({static_cast<int>(column), index_row(static_cast<int>(row), zoom)}, geometry.cell_m);
  if (!tile.intersection(geometry)) throw CorruptData(kCorrupt, "they lie outside the terrain");
  copy_common(decode_heights(png), tile, terrain.codes, geometry);
}

Contents read_contents(Connection& map) {
  const auto geometry = read_geometry(map);
  if (!geometry) return {.damage = {{0, "roadfix_terrain_source names no cells that heights can have"}}};
  Contents contents{.terrain = Terrain::unknown(*geometry), .damage = {}};
  Statement tiles(map,
                  "SELECT id, tile_column, tile_row, tile_data FROM roadfix_terrain ORDER BY tile_row, tile_column");
  while (tiles.step()) {
    try {
      paste_tile(tiles.integer(1), tiles.integer(2), tiles.blob(3), contents.terrain);
    } catch (const CorruptData& error) {
      contents.damage.push_back({tiles.integer(0), fmt::format("the heights of tile column {} row {} are damaged: {}",
                                                               tiles.integer(1), tiles.integer(2), error.what())});
    }
  }
  return contents;
}

}  // namespace

void put_terrain(Connection& map, const Terrain& terrain, const TerrainRecord& record) {
  const GridGeometry& geometry = terrain.geometry;
  assert(is_terrain_cell_size(geometry.cell_m) && std::int64_t{geometry.cols} * geometry.rows <= kMostTerrainCells);
  assert(heights_of(terrain).has_value());
  remove_terrain(map);
  map.execute(std::string(schema::terrain_sql()).c_str());
  const GridBox box = geometry.box();
  const Provenance& told = record.provenance;
  Statement(map,
            fmt::format("INSERT INTO roadfix_terrain_source VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, {})", kSqlNow))
      .with(geometry.cell_m, box.min.east_m, box.min.north_m, box.max.east_m, box.max.north_m, record.location,
            told.date, told.licence, told.attribution)
      .run();
  Statement put(map, "INSERT INTO roadfix_terrain (tile_column, tile_row, tile_data) VALUES (?1, ?2, ?3)");
  for (const TileIndex index : tiles_covering(geometry)) {
    Terrain tile = Terrain::unknown(tile_geometry(index, geometry.cell_m));
    copy_common(terrain.codes, geometry, tile.codes, tile.geometry);
    if (std::ranges::none_of(tile.codes, is_known)) continue;
    const std::vector<std::byte> png = encode_heights(tile.codes);
    put.with(index.col, tile_row(index, zoom_of(geometry.cell_m)), std::span(png)).run();
  }
}

bool remove_terrain(Connection& map) {
  if (!has_terrain(map)) return false;
  map.execute(
      "DROP TABLE roadfix_terrain; DROP TABLE IF EXISTS roadfix_terrain_source; DELETE FROM gpkg_extensions WHERE "
      "table_name IN ('roadfix_terrain', 'roadfix_terrain_source')");
  return true;
}

std::optional<TerrainStatus> read_terrain(Connection& map, const GridBox& extent) {
  if (!has_terrain(map)) return std::nullopt;
  auto [terrain, damage] = read_contents(map);
  if (!damage.empty()) throw corrupt(map, damage.front().what);
  const auto heights = heights_of(terrain);
  if (!heights) throw corrupt(map, "its terrain has no heights");
  Statement row(map, "SELECT location, date, licence, attribution, added_at FROM roadfix_terrain_source");
  row.step();
  return TerrainStatus{
      .record = {.location = row.text(0),
                 .provenance = {.date = row.text(1), .licence = row.text(2), .attribution = row.text(3)}},
      .added_at = row.text(4),
      .heights = *heights,
      .known_share = known_share(terrain, extent),
      .terrain = std::make_shared<const Terrain>(std::move(terrain))};
}

std::vector<std::string> damage_of_terrain(Connection& map) {
  std::vector<std::string> damage;
  if (!has_terrain(map)) return damage;
  try {
    const Contents contents = read_contents(map);
    for (const Damage& each : contents.damage) damage.push_back(each.what);
    if (damage.empty() && !heights_of(contents.terrain)) damage.emplace_back("the terrain has no heights");
  } catch (const CorruptData& error) {
    damage.emplace_back(error.what());
  }
  return damage;
}

std::vector<std::string> drop_damaged_terrain(Connection& map) {
  std::vector<std::string> damage = damage_of_terrain(map);
  if (damage.empty()) return damage;
  try {
    Statement drop(map, "DELETE FROM roadfix_terrain WHERE id = ?1");
    for (const Damage& each : read_contents(map).damage) drop.with(each.tile).run();
    read_terrain(map, kNothingObserved);
  } catch (const CorruptData&) {
    remove_terrain(map);
  }
  return damage;
}

}  // namespace roadfix
