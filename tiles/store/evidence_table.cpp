#include "tiles/store/evidence_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <set>
#include <utility>

#include "core/units/error.hpp"
#include "tiles/store/fusion.hpp"
#include "tiles/store/tile_matrix.hpp"
#include "tiles/store/tile_png.hpp"

namespace roadfix {

using sqlite::Statement;

CellArray decoded_evidence(const std::filesystem::path& map, const EvidencePlace& place,
                           std::span<const std::byte> png) {
  try {
    return decode_tile(png, TileDepth::kEvidence);
  } catch (const CorruptData& error) {
    throw CorruptData(error.code(), fmt::format("{}: evidence of source '{}' column {} row {} is damaged: {}. Ingest "
                                                "the source again with --replace",
                                                map.string(), place.source, place.column, place.row, error.what()));
  }
}

EvidenceTable::EvidenceTable(sqlite::Connection& map, int finest_zoom)
    : map_(map),
      zoom_(finest_zoom),
      put_(map,
           "INSERT OR REPLACE INTO roadfix_evidence (source_id, tile_column, tile_row, tile_data) VALUES (?1, ?2, ?3, "
           "?4)"),
      remove_(map, "DELETE FROM roadfix_evidence WHERE source_id = ?1 AND tile_column = ?2 AND tile_row = ?3"),
      mark_done_(map,
                 "UPDATE roadfix_blocks SET done = 1 WHERE source_id = ?1 AND tile_column = ?2 AND tile_row = ?3 "
                 "RETURNING 1") {}

bool EvidenceTable::put(std::int64_t source_id, TileIndex block, const CellArray& cells) {
  assert(cells.cols() == kTileCells && cells.rows() == kTileCells);
  const int row = tile_row(block, zoom_);
  const bool expected = mark_done_.with(source_id, block.col, row).step();
  mark_done_.reset();
  if (!expected) return false;
  if (cells.any_observed()) {
    const std::vector<std::byte> png = encode_tile(cells, TileDepth::kEvidence);
    put_.with(source_id, block.col, row, std::span(png)).run();
  } else {
    remove_.with(source_id, block.col, row).run();
  }
  return true;
}

std::vector<std::string> EvidenceTable::twins_of(const std::string& source) {
  std::vector<std::string> names;
  // Equal cells are equal bytes. What is used twice, SQLite would first copy into a temporary file, all tiles of it.
  Statement twins(
      map_,
      "WITH own AS NOT MATERIALIZED (SELECT e.tile_column, e.tile_row, e.tile_data FROM roadfix_evidence e JOIN "
      "roadfix_sources s ON s.id = e.source_id WHERE s.name = ?1 AND s.in_force = 1) SELECT name FROM roadfix_sources "
      "s WHERE in_force = 1 AND name <> ?1 "
      "AND EXISTS (SELECT 1 FROM own) AND NOT EXISTS (SELECT 1 FROM own WHERE NOT EXISTS (SELECT 1 FROM "
      "roadfix_evidence o WHERE o.source_id = s.id AND o.tile_column = own.tile_column AND o.tile_row = "
      "own.tile_row AND o.tile_data = own.tile_data)) ORDER BY name");
  for (twins.with(source); twins.step();) names.push_back(twins.text(0));
  return names;
}

std::vector<EvidencePlace> EvidenceTable::places_shared(const std::string& source, std::span<const Witness> witnesses) {
  // By the ledger, which is sorted by source: evidence is sorted by tile, and a search through all of it takes long.
  Statement shared(map_,
                   "SELECT b.tile_row, b.tile_column FROM roadfix_sources s CROSS JOIN roadfix_sources t CROSS JOIN "
                   "roadfix_blocks b ON b.source_id = s.id WHERE s.name = ?1 AND s.in_force = 1 AND t.name = ?2 AND "
                   "t.in_force = 1 AND (SELECT count(*) FROM roadfix_evidence e WHERE e.tile_row = b.tile_row AND "
                   "e.tile_column = b.tile_column AND e.source_id IN (s.id, t.id)) = 2");
  std::set<std::pair<std::int64_t, std::int64_t>> places;
  for (const Witness& witness : witnesses) {
    for (const std::string& other : witness) {
      for (shared.with(source, other); shared.step();) places.emplace(shared.integer(0), shared.integer(1));
    }
  }
  std::vector<EvidencePlace> result;
  for (const auto& [row, column] : places) result.push_back({source, column, row});
  return result;
}

SharedEvidence EvidenceTable::shared_evidence(const std::string& source, std::span<const Witness> witnesses,
                                              std::int64_t count) {
  const std::vector<EvidencePlace> places = places_shared(source, witnesses);
  Statement evidence(
      map_,
      "SELECT e.tile_data, s.registration_sigma_m FROM roadfix_evidence e JOIN roadfix_sources s ON s.id = e.source_id "
      "WHERE s.name = ?1 AND s.in_force = 1 AND e.tile_row = ?2 AND e.tile_column = ?3");
  const auto said = [&](const std::string& name, const EvidencePlace& place, double& sigma_m) {
    std::optional<CellArray> cells;
    if (evidence.with(name, place.row, place.column).step()) {
      cells = decoded_evidence(map_.path(), {name, place.column, place.row}, evidence.blob(0));
      sigma_m = std::max(sigma_m, evidence.real(1));
    }
    evidence.reset();
    return cells;
  };
  SharedEvidence result;
  const std::int64_t all = std::ssize(places);
  for (std::int64_t i = 0; i < all; ++i) {
    if (i * count / all == (i + 1) * count / all) continue;
    const EvidencePlace& place = places[static_cast<std::size_t>(i)];
    std::vector<CellArray> others;
    for (const Witness& witness : witnesses) {
      std::vector<CellArray> one;
      for (const std::string& name : witness) {
        if (auto cells = said(name, place, result.others_sigma_m)) one.push_back(std::move(*cells));
      }
      if (!one.empty()) others.push_back(fused(one));
    }
    result.tiles.push_back({*said(source, place, result.own_sigma_m), fused(others)});
  }
  return result;
}

std::vector<std::string> EvidenceTable::sources_sharing_ground(const std::string& source) {
  std::vector<std::string> names;
  Statement sharing(map_,
                    "WITH own AS (SELECT id FROM roadfix_sources WHERE name = ?1 AND in_force = 1) SELECT DISTINCT "
                    "s.name FROM roadfix_evidence e JOIN roadfix_evidence o ON o.tile_row = e.tile_row AND "
                    "o.tile_column = e.tile_column JOIN roadfix_sources s ON s.id = o.source_id WHERE e.source_id IN "
                    "own AND s.in_force = 1 AND s.name <> ?1 ORDER BY s.name");
  for (sharing.with(source); sharing.step();) names.push_back(sharing.text(0));
  return names;
}

std::vector<std::string> EvidenceTable::drop_damaged() {
  std::vector<std::int64_t> damaged;
  for (Statement all(map_,
                     "SELECT e.id, e.tile_data, b.done FROM roadfix_evidence e LEFT JOIN roadfix_blocks b ON "
                     "b.source_id = e.source_id AND b.tile_row = e.tile_row AND b.tile_column = e.tile_column");
       all.step();) {
    if (all.integer(2) != 1) {
      damaged.push_back(all.integer(0));
      continue;
    }
    try {
      decode_tile(all.blob(1), TileDepth::kEvidence);
    } catch (const CorruptData&) {
      damaged.push_back(all.integer(0));
    }
  }
  std::set<std::string> names;
  Statement source(map_,
                   "UPDATE roadfix_sources SET fingerprint = '' WHERE id = (SELECT source_id FROM roadfix_evidence "
                   "WHERE id = ?1) RETURNING name");
  Statement unfinished(map_,
                       "UPDATE roadfix_blocks SET done = 0 WHERE (source_id, tile_row, tile_column) = (SELECT "
                       "source_id, tile_row, tile_column FROM roadfix_evidence WHERE id = ?1)");
  Statement remove(map_, "DELETE FROM roadfix_evidence WHERE id = ?1");
  for (const std::int64_t id : damaged) {
    if (source.with(id).step()) names.insert(source.text(0));
    source.reset();
    unfinished.with(id).run();
    remove.with(id).run();
  }
  return {names.begin(), names.end()};
}

}  // namespace roadfix
