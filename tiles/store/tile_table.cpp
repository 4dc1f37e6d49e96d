#include "tiles/store/tile_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "core/grid/observed_range.hpp"
#include "core/grid/resample.hpp"
#include "core/units/error.hpp"
#include "tiles/store/evidence_table.hpp"
#include "tiles/store/fusion.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/tile_matrix.hpp"
#include "tiles/store/tile_png.hpp"

namespace roadfix {
namespace {

/// Cells of the lattice that a tile has seen something in.
struct ObservedCells {
  int west = std::numeric_limits<int>::max();
  int north = std::numeric_limits<int>::max();
  int east = std::numeric_limits<int>::min();
  int south = std::numeric_limits<int>::min();

  void add(TileIndex tile, const CellArray& cells) {
    for (int row = 0; row < cells.rows(); ++row) {
      const auto seen = observed_in(cells.row(row));
      if (!seen) continue;
      west = std::min(west, tile.col * kTileCells + seen->first);
      east = std::max(east, tile.col * kTileCells + seen->end);
      north = std::min(north, tile.row * kTileCells + row);
      south = std::max(south, tile.row * kTileCells + row + 1);
    }
  }
  GridBox box(double cell_m) const {
    if (east < west) return kNothingObserved;
    return GridGeometry{cell_m, {west, north}, east - west, south - north}.box();
  }
};

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

TileTable::TileTable(sqlite::Connection& map, const MapSettings& settings)
    : map_(map),
      cell_m_(settings.cell_m),
      finest_(zoom_of(settings.cell_m)),
      select_(
          map,
          "SELECT tile_data, id FROM road_probability WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3"),
      update_(map, "UPDATE road_probability SET tile_data = ?2 WHERE id = ?1"),
      insert_(map,
              "INSERT INTO road_probability (zoom_level, tile_column, tile_row, tile_data) VALUES (?1, ?2, ?3, ?4)"),
      insert_ancillary_(
          map, "INSERT INTO gpkg_2d_gridded_tile_ancillary (tpudt_name, tpudt_id) VALUES ('road_probability', ?1)"),
      remove_ancillary_(
          map, "DELETE FROM gpkg_2d_gridded_tile_ancillary WHERE tpudt_name = 'road_probability' AND tpudt_id = ?1"),
      remove_(map, "DELETE FROM road_probability WHERE id = ?1"),
      evidence_(map,
                "SELECT e.tile_data, s.name FROM roadfix_evidence e JOIN roadfix_sources s ON s.id = e.source_id "
                "WHERE e.tile_column = ?1 AND e.tile_row = ?2 AND s.in_force = 1 ORDER BY s.name"),
      set_version_(map, "UPDATE roadfix_meta SET value = ?1 WHERE key = 'version'") {}

std::optional<CellArray> TileTable::tile(int zoom, TileIndex index) {
  std::vector<std::byte> png;
  {
    const std::lock_guard lock(mutex_);
    const sqlite::ResetAtEnd reset(select_);
    if (!select_.with(zoom, index.col, tile_row(index, zoom)).step()) return std::nullopt;
    png = copy_of(select_.blob(0));
  }
  try {
    return decode_tile(png, TileDepth::kFused);
  } catch (const CorruptData& error) {
    throw CorruptData(error.code(),
                      fmt::format("{}: tile zoom {} column {} row {} is damaged: {}", map_.path().string(), zoom,
                                  index.col, tile_row(index, zoom), error.what()));
  }
}

void TileTable::put(int zoom, TileIndex index, std::span<const std::byte> png) {
  const int row = tile_row(index, zoom);
  std::uint64_t difference = png.empty() ? 0 : content_hash(index, png);
  if (select_.with(zoom, index.col, row).step()) {
    if (std::ranges::equal(select_.blob(0), png)) return select_.reset();
    difference -= content_hash(index, select_.blob(0));
    const std::int64_t id = select_.integer(1);
    select_.reset();
    if (png.empty()) {
      remove_ancillary_.with(id).run();
      remove_.with(id).run();
    } else {
      update_.with(id, png).run();
    }
  } else {
    if (png.empty()) return;
    insert_.with(zoom, index.col, row, png).run();
    insert_ancillary_.with(map_.last_insert_id()).run();
  }
  if (zoom == finest_) add_to_version(difference);
}

void TileTable::add_to_version(std::uint64_t difference) {
  const std::string text = read_version(map_);
  std::uint64_t version = 0;
  std::from_chars(text.data(), text.data() + text.size(), version, 16);
  set_version_.with(version_text(version + difference)).run();
}

std::optional<CellArray> TileTable::derived(int zoom, TileIndex index) {
  return zoom == finest_ ? fused_evidence(index) : overview(zoom, index);
}

std::optional<CellArray> TileTable::fused_evidence(TileIndex index) {
  struct Said {
    std::vector<std::byte> png;
    std::string source;
  };
  std::vector<Said> evidence;
  {
    const std::lock_guard lock(mutex_);
    const sqlite::ResetAtEnd reset(evidence_);
    evidence_.with(index.col, tile_row(index, finest_));
    while (evidence_.step()) evidence.push_back({copy_of(evidence_.blob(0)), evidence_.text(1)});
  }
  std::vector<CellArray> sources;
  for (const auto& [png, source] : evidence) {
    sources.push_back(decoded_evidence(map_.path(), {source, index.col, tile_row(index, finest_)}, png));
  }
  if (sources.empty()) return std::nullopt;
  return fused(sources);
}

std::optional<CellArray> TileTable::overview(int zoom, TileIndex index) {
  CellArray below(2 * kTileCells, 2 * kTileCells);
  bool any = false;
  for (int row = 0; row < 2; ++row) {
    for (int col = 0; col < 2; ++col) {
      const auto child = tile(zoom + 1, {2 * index.col + col, 2 * index.row + row});
      if (!child) continue;
      paste(*child, below, col * kTileCells, row * kTileCells);
      any = true;
    }
  }
  if (!any) return std::nullopt;
  return halved(below);
}

GridBox TileTable::observed_extent() {
  // Only tiles on the rim of the tile rectangle can hold an outermost cell.
  sqlite::Statement rim(
      map_,
      "WITH t AS (SELECT tile_column AS c, tile_row AS r FROM road_probability WHERE zoom_level = ?1 AND "
      "tile_column BETWEEN 0 AND ?2 AND tile_row BETWEEN 0 AND ?3), "
      "b AS (SELECT min(c) AS west, max(c) AS east, min(r) AS north, max(r) AS south FROM t) "
      "SELECT c, r FROM t, b WHERE c IN (west, east) OR r IN (north, south)");
  ObservedCells observed;
  rim.with(finest_, matrix_width(finest_) - 1, matrix_height(finest_) - 1);
  while (rim.step()) {
    const TileIndex index{static_cast<int>(rim.integer(0)), index_row(static_cast<int>(rim.integer(1)), finest_)};
    if (const auto cells = tile(finest_, index)) observed.add(index, *cells);
  }
  return observed.box(cell_m_);
}

}  // namespace roadfix
