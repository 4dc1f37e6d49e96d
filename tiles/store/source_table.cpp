#include "tiles/store/source_table.hpp"

#include <fmt/format.h>

#include "core/units/error.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/shift_table.hpp"
#include "tiles/store/tile_matrix.hpp"

namespace roadfix {

using sqlite::Connection;
using sqlite::Statement;

namespace {

SourceContent content_of(const Connection& map, const std::string& kind) {
  if (const auto content = value_of(kSourceContents, kind)) return *content;
  throw CorruptData("map-corrupt",
                    fmt::format("{}: roadfix_sources has a source of the kind '{}', which no map can have. Restore the "
                                "map from a copy",
                                map.path().string(), kind));
}

}  // namespace

SourceTable::SourceTable(Connection& map, int finest_zoom) : map_(map), zoom_(finest_zoom) {}

std::optional<SourceTable::Entry> SourceTable::find(const std::string& name, bool in_force) {
  Statement select(map_,
                   "SELECT id, fingerprint, kind, method, registration_sigma_m FROM roadfix_sources WHERE name = ?1 "
                   "AND in_force = ?2");
  if (!select.with(name, in_force).step()) return std::nullopt;
  return Entry{select.integer(0), select.text(1), content_of(map_, select.text(2)), select.text(3), select.real(4)};
}

std::int64_t SourceTable::insert(const SourceRecord& record) {
  Statement(map_,
            "INSERT INTO roadfix_sources (name, kind, location, fingerprint, date, licence, attribution, method, "
            "registration_sigma_m, in_force, ingested_at) VALUES (?1, '', '', ?2, '', '', '', '', 0, 0, '')")
      .with(record.name, record.fingerprint)
      .run();
  return map_.last_insert_id();
}

void SourceTable::set_provenance(std::int64_t id, const SourceRecord& r) {
  const Provenance& p = r.provenance;
  Statement(map_,
            "UPDATE roadfix_sources SET kind = ?2, location = ?3, date = ?4, licence = ?5, attribution = ?6, "
            "method = ?7, registration_sigma_m = ?8 WHERE id = ?1")
      .with(id, to_string(r.content), r.location, p.date, p.licence, p.attribution, r.method, p.registration_sigma_m)
      .run();
}

std::vector<SourceStatus> SourceTable::all() {
  Statement select(map_,
                   "SELECT name, kind, location, fingerprint, method, date, licence, attribution, "
                   "registration_sigma_m, in_force, ingested_at, "
                   "(SELECT count(*) FROM roadfix_blocks b WHERE b.source_id = s.id), "
                   "(SELECT total(done) FROM roadfix_blocks b WHERE b.source_id = s.id) "
                   "FROM roadfix_sources s ORDER BY name, in_force DESC");
  const auto shifts = read_shifts(map_);
  std::vector<SourceStatus> sources;
  while (select.step()) {
    SourceStatus status{.record = {.name = select.text(0),
                                   .content = content_of(map_, select.text(1)),
                                   .location = select.text(2),
                                   .fingerprint = select.text(3),
                                   .method = select.text(4),
                                   .provenance = {.date = select.text(5),
                                                  .licence = select.text(6),
                                                  .attribution = select.text(7),
                                                  .registration_sigma_m = select.real(8)}}};
    status.complete = select.integer(9) != 0;
    status.ingested_at = select.text(10);
    status.blocks_total = select.integer(11);
    status.blocks_done = select.integer(12);
    const auto shift = shifts.find(status.record.name);
    if (status.complete && shift != shifts.end()) status.shift = shift->second;
    sources.push_back(std::move(status));
  }
  return sources;
}

std::vector<std::pair<std::int64_t, std::string>> SourceTable::in_force() {
  Statement select(map_, "SELECT id, name FROM roadfix_sources WHERE in_force = 1 ORDER BY id");
  std::vector<std::pair<std::int64_t, std::string>> sources;
  while (select.step()) sources.emplace_back(select.integer(0), select.text(1));
  return sources;
}

std::set<TileIndex> SourceTable::done_blocks(std::int64_t id) {
  Statement select(map_, "SELECT tile_column, tile_row FROM roadfix_blocks WHERE source_id = ?1 AND done = 1");
  select.with(id);
  std::set<TileIndex> done;
  while (select.step()) {
    done.insert({static_cast<int>(select.integer(0)), index_row(static_cast<int>(select.integer(1)), zoom_)});
  }
  return done;
}

void SourceTable::set_ledger(std::int64_t id, std::span<const TileIndex> blocks) {
  const std::set<TileIndex> done = done_blocks(id);
  Statement(map_, "DELETE FROM roadfix_blocks WHERE source_id = ?1").with(id).run();
  Statement insert(map_,
                   "INSERT OR IGNORE INTO roadfix_blocks (source_id, tile_row, tile_column, done) VALUES (?1, ?2, "
                   "?3, ?4)");
  for (const TileIndex block : blocks) {
    insert.with(id, tile_row(block, zoom_), block.col, done.contains(block)).run();
  }
  Statement(map_,
            "DELETE FROM roadfix_evidence WHERE source_id = ?1 AND NOT EXISTS (SELECT 1 FROM roadfix_blocks b WHERE "
            "b.source_id = ?1 AND b.tile_row = roadfix_evidence.tile_row AND b.tile_column = "
            "roadfix_evidence.tile_column)")
      .with(id)
      .run();
}

void SourceTable::put_in_force(std::int64_t id) {
  Statement(map_, fmt::format("UPDATE roadfix_sources SET in_force = 1, ingested_at = {} WHERE id = ?1", kSqlNow))
      .with(id)
      .run();
}

void SourceTable::remove(std::int64_t id) {
  for (const char* sql :
       {"DELETE FROM roadfix_evidence WHERE source_id = ?1", "DELETE FROM roadfix_blocks WHERE source_id = ?1",
        "DELETE FROM roadfix_shifts WHERE source_id = ?1", "DELETE FROM roadfix_sources WHERE id = ?1"}) {
    Statement(map_, sql).with(id).run();
  }
}

void SourceTable::require_complete(std::int64_t id, const std::string& name) {
  Statement open(map_, "SELECT count(*) FROM roadfix_blocks WHERE source_id = ?1 AND done = 0");
  open.with(id).step();
  if (open.integer(0) == 0) return;
  throw InvalidInput("source-incomplete", fmt::format("{}: source '{}' lacks {} blocks. Ingest it again to go on",
                                                      map_.path().string(), name, open.integer(0)));
}

}  // namespace roadfix
