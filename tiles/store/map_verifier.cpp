#include "tiles/store/map_verifier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "tiles/store/map_description.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/terrain_table.hpp"
#include "tiles/store/tile_matrix.hpp"
#include "tiles/store/tile_png.hpp"
#include "tiles/store/tile_table.hpp"

namespace roadfix {
namespace {

using sqlite::Access;
using sqlite::Connection;
using sqlite::number;
using sqlite::Statement;

class Verifier {
 public:
  Verifier(const std::filesystem::path& path, const OnProgress& progress, std::stop_token stop)
      : map_(open_map(path, Access::kRead)),
        settings_(settings_as_written(map_)),
        table_(map_, settings_),
        progress_(progress),
        stop_(std::move(stop)) {}

  MapVerdict verdict() {
    const std::int64_t at_start = number(map_, "PRAGMA data_version");
    total_ = number(map_, "SELECT (SELECT count(*) FROM road_probability) + (SELECT count(*) FROM roadfix_evidence)");
    check_database();
    if (!verdict_.problems.empty()) return std::move(verdict_);  // tables of a damaged database say nothing reliable
    std::ranges::move(problems_of_description(map_, settings_), std::back_inserter(verdict_.problems));
    check_pending();
    check_ledger();
    check_evidence();
    check_terrain();
    for (int zoom = table_.finest_zoom(); zoom >= kCoarsestZoom; --zoom) check_level(zoom);
    check_summary();
    if (number(map_, "PRAGMA data_version") != at_start) {
      throw InUse("map-changed", fmt::format("{}: it was written to while it was being verified. Repeat when the "
                                             "ingest has ended",
                                             map_.path().string()));
    }
    return std::move(verdict_);
  }

 private:
  std::vector<std::int64_t> ids(const std::string& sql) {
    std::vector<std::int64_t> found;
    for (Statement rows(map_, sql); rows.step();) found.push_back(rows.integer(0));
    return found;
  }

  void report(std::string code, std::string what) { verdict_.problems.push_back({std::move(code), std::move(what)}); }

  static Interrupted stopped() { return {"work-stopped", "verify was stopped before it had seen every tile"}; }

  void step() {
    if (stop_.stop_requested()) throw stopped();
    ++done_;
    if (progress_) progress_(done_, std::max(done_, total_));
  }

  void check_database() {
    for (const char* pragma : {"PRAGMA integrity_check", "PRAGMA foreign_key_check"}) {
      Statement check(map_, pragma);
      while (check.step()) {
        if (check.text(0) != "ok") {
          report("database-damaged", fmt::format("{}: {}. Restore the map from a copy", pragma + 7, check.text(0)));
        }
      }
    }
  }

  void report_outside(const char* what, std::int64_t zoom, std::int64_t col, std::int64_t row) {
    report("tile-outside-lattice",
           fmt::format("{} zoom {} column {} row {} lies outside the lattice. {}", what, zoom, col, row, kRepair));
  }

  void check_pending() {
    verdict_.tiles_to_fuse = count_pending(map_);
    Statement waiting(map_, "SELECT zoom_level, tile_column, tile_row FROM roadfix_pending");
    while (waiting.step()) {
      if (in_pyramid(waiting.integer(0), waiting.integer(2), waiting.integer(1), table_.finest_zoom())) continue;
      report_outside("waiting tile", waiting.integer(0), waiting.integer(1), waiting.integer(2));
    }
  }

  void check_ledger() {
    const std::int64_t unexplained =
        number(map_,
               "SELECT count(*) FROM roadfix_evidence e LEFT JOIN roadfix_blocks b ON b.source_id = e.source_id AND "
               "b.tile_row = e.tile_row AND b.tile_column = e.tile_column WHERE b.done IS NOT 1");
    if (unexplained > 0) {
      report("ledger-broken",
             fmt::format("{} tiles of evidence belong to no finished block of a source. {}", unexplained, kRepair));
    }
    Statement open(map_,
                   "SELECT s.name, count(*) FROM roadfix_sources s JOIN roadfix_blocks b ON b.source_id = s.id WHERE "
                   "s.in_force = 1 AND b.done = 0 GROUP BY s.id");
    while (open.step()) {
      report("ledger-broken",
             fmt::format("source '{}' is in force but lacks {} blocks. Ingest it again with --replace, or restore the "
                         "map from a copy",
                         open.text(0), open.integer(1)));
    }
  }

  void check_evidence() {
    Statement evidence(map_,
                       "SELECT e.tile_data, s.name, e.tile_column, e.tile_row FROM roadfix_evidence e LEFT JOIN "
                       "roadfix_sources s ON s.id = e.source_id WHERE e.id = ?1");
    // One query per tile: a single one would lock writers out until the last tile is read.
    for (const std::int64_t id : ids("SELECT id FROM roadfix_evidence")) {
      step();
      const sqlite::ResetAtEnd reset(evidence);
      if (!evidence.with(id).step()) continue;  // a writer has removed it
      ++verdict_.evidence;
      try {
        decode_tile(evidence.blob(0), TileDepth::kEvidence);
      } catch (const CorruptData& error) {
        report("evidence-corrupt", fmt::format("evidence of source '{}' column {} row {}: {}. {}", evidence.text(1),
                                               evidence.integer(2), evidence.integer(3), error.what(), kRepair));
      }
    }
  }

  void check_terrain() {
    for (const std::string& what : damage_of_terrain(map_)) {
      report("terrain-damaged", fmt::format("{}. {}", what, kRepair));
    }
  }

  /// Every tile that is there or should be.
  std::vector<TileIndex> tiles_of_level(int zoom) {
    Statement select(map_,
                     zoom == table_.finest_zoom()
                         ? "SELECT tile_row, tile_column FROM road_probability WHERE zoom_level = ?1 UNION "
                           "SELECT tile_row, tile_column FROM roadfix_evidence ORDER BY 1, 2"
                         : "SELECT tile_row, tile_column FROM road_probability WHERE zoom_level = ?1 UNION "
                           "SELECT tile_row >> 1, tile_column >> 1 FROM road_probability WHERE zoom_level = ?1 + 1 "
                           "ORDER BY 1, 2");
    std::vector<TileIndex> tiles;
    select.with(zoom);
    while (select.step()) {
      const std::int64_t row = select.integer(0);
      const std::int64_t col = select.integer(1);
      if (in_pyramid(zoom, row, col, table_.finest_zoom())) {
        tiles.push_back({static_cast<int>(col), index_row(static_cast<int>(row), zoom)});
      } else {
        report_outside("tile", zoom, col, row);
      }
    }
    return tiles;
  }

  void check_level(int zoom) {
    Statement pending(map_,
                      "SELECT 1 FROM roadfix_pending WHERE zoom_level = ?1 AND tile_row = ?2 AND tile_column = ?3");
    for (const TileIndex index : tiles_of_level(zoom)) {
      const int row = tile_row(index, zoom);
      std::optional<CellArray> stored;
      try {
        stored = table_.tile(zoom, index);
      } catch (const CorruptData& error) {
        step();
        ++verdict_.tiles;
        report(error.code(), error.what());
        continue;
      }
      if (stored) {
        step();
        ++verdict_.tiles;
      }
      const sqlite::ResetAtEnd reset(pending);
      if (pending.with(zoom, row, index.col).step()) continue;
      const auto expected = expected_tile(zoom, index);
      if (!expected || *expected == stored.value_or(CellArray(kTileCells, kTileCells))) continue;
      report(zoom == table_.finest_zoom() ? "tile-not-fused" : "overview-differs",
             fmt::format("tile zoom {} column {} row {} does not follow from {}. {}", zoom, index.col, row,
                         zoom == table_.finest_zoom() ? "the evidence" : "the level below", kRepair));
    }
  }

  /// nullopt where what it follows from is damaged, which has been reported already.
  std::optional<CellArray> expected_tile(int zoom, TileIndex index) {
    try {
      return table_.derived(zoom, index).value_or(CellArray(kTileCells, kTileCells));
    } catch (const CorruptData&) {
      return std::nullopt;
    }
  }

  void check_summary() {
    if (!verdict_.problems.empty()) return;  // they follow from the tiles, and some of these are wrong
    const MapInfo info = read_info(map_);
    std::ranges::copy_if(info.sources, std::back_inserter(verdict_.unfinished),
                         [](const SourceStatus& source) { return !source.complete; });
    const GridBox extent = table_.observed_extent();
    const bool same =
        (extent.empty() && info.extent.empty()) || (extent.min == info.extent.min && extent.max == info.extent.max);
    if (!same && verdict_.tiles_to_fuse == 0)  // it is written with the last tile
      report("extent-wrong",
             "gpkg_contents does not give the box of the observed cells. Repair it with roadfix verify --repair");
    std::uint64_t sum = 0;
    Statement tiles(map_, "SELECT tile_column, tile_row, tile_data FROM road_probability WHERE id = ?1");
    for (const std::int64_t id :
         ids(fmt::format("SELECT id FROM road_probability WHERE zoom_level = {}", table_.finest_zoom()))) {
      if (stop_.stop_requested()) throw stopped();
      const sqlite::ResetAtEnd reset(tiles);
      if (!tiles.with(id).step()) continue;  // a writer has removed it
      sum += content_hash(
          {static_cast<int>(tiles.integer(0)), index_row(static_cast<int>(tiles.integer(1)), table_.finest_zoom())},
          tiles.blob(2));
    }
    if (version_text(sum) != info.version) {
      report("version-wrong",
             "the version in roadfix_meta is not that of the tiles. Repair it with roadfix verify --repair");
    }
  }

  Connection map_;
  MapSettings settings_;
  TileTable table_;
  OnProgress progress_;
  std::stop_token stop_;
  std::int64_t done_ = 0;
  std::int64_t total_ = 0;
  MapVerdict verdict_;
};

}  // namespace

MapVerdict verify_map(const std::filesystem::path& path, const OnProgress& progress, std::stop_token stop) {
  return Verifier(path, progress, std::move(stop)).verdict();
}

}  // namespace roadfix
