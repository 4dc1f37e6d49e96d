#include "tiles/store/map_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "tiles/store/create_map.hpp"
#include "tiles/store/evidence_table.hpp"
#include "tiles/store/fusion_queue.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/shift_table.hpp"
#include "tiles/store/source_table.hpp"
#include "tiles/store/terrain_table.hpp"
#include "tiles/store/tile_matrix.hpp"
#include "tiles/store/tile_table.hpp"
#include "tiles/store/writer_lock.hpp"

namespace roadfix {
namespace {

using sqlite::Access;
using sqlite::Connection;
using sqlite::Statement;
using sqlite::Transaction;

/// Makes the map where there is none, and says so.
bool create_if_missing(const std::filesystem::path& path, const MapSettings& settings) {
  if (is_there(path)) return false;
  create_map(path, settings);
  return true;
}

Connection open_with(const std::filesystem::path& path, const MapSettings& settings, Access access) {
  Connection map = open_map(path, access);
  const MapSettings existing = read_settings(map);
  if (existing != settings) {
    throw InvalidInput(
        "map-settings-differ",
        fmt::format("{}: the map has EPSG:{} and cells of {} m, not EPSG:{} and {} m. Use its settings or "
                    "another map",
                    path.string(), existing.zone.epsg(), existing.cell_m, settings.zone.epsg(), settings.cell_m));
  }
  return map;
}

/// Why the same command may be refused after an update of roadfix: it has another detector, or takes the file for
/// something else.
std::string what_roadfix_changed(const SourceTable::Entry& before, const SourceRecord& now) {
  if (before.content != now.content) {
    return fmt::format(" (as {}; now it is {})", to_string(before.content), to_string(now.content));
  }
  if (now.content != SourceContent::kImagery || before.method == now.method) return "";
  return fmt::format(" (made by {}; now it is {})", before.method, now.method);
}

void refuse_other_content(const Connection& map, SourceTable& sources, const SourceRecord& record) {
  const auto in_force = sources.find(record.name, true);
  const auto unfinished = sources.find(record.name, false);
  const auto same = [&](const auto& entry) { return entry && entry->fingerprint == record.fingerprint; };
  if ((!in_force && !unfinished) || same(in_force) || same(unfinished)) return;
  throw InvalidInput("source-exists",
                     fmt::format("{}: a source named '{}' with other content or settings is in the map already{}. "
                                 "Replace it with --replace, or give this one another name",
                                 map.path().string(), record.name,
                                 what_roadfix_changed(unfinished ? *unfinished : *in_force, record)));
}

}  // namespace

struct MapWriter::State {
  /// `path` is no link, so that all writers of a map use one lock, and a new map does not replace a link.
  State(const std::filesystem::path& path, const MapSettings& wanted)
      : lock(path),
        made_here(create_if_missing(path, wanted)),
        settings(wanted),
        map(open_with(path, settings, Access::kReadWrite)),
        tiles(map, settings),
        sources(map, tiles.finest_zoom()),
        evidence(map, tiles.finest_zoom()),
        fusion(map, tiles) {}

  NotFound no_source(const std::string& name) const {
    return {"source-not-found",
            fmt::format("{}: there is no source named '{}'. roadfix info names those that are there",
                        map.path().string(), name)};
  }

  WriterLock lock;
  bool made_here;
  MapSettings settings;
  Connection map;
  TileTable tiles;
  SourceTable sources;
  EvidenceTable evidence;
  FusionQueue fusion;
};

MapWriter::MapWriter(const std::filesystem::path& path, const MapSettings& settings)
    : state_(std::make_unique<State>(behind_links(path), settings)) {}
MapWriter::~MapWriter() = default;
MapWriter::MapWriter(MapWriter&&) noexcept = default;
MapWriter& MapWriter::operator=(MapWriter&&) noexcept = default;

const MapSettings& MapWriter::settings() const { return state_->settings; }
GridBox MapWriter::extent() const { return read_extent(state_->map); }

MapWriter MapWriter::existing(const std::filesystem::path& path) {
  Connection map = open_map(path, Access::kRead);
  return {path, read_settings(map)};
}

void MapWriter::require_acceptable(const std::filesystem::path& path, const MapSettings& settings,
                                   const SourceRecord& record, bool replace) {
  if (!is_there(path)) return;
  Connection map = open_with(path, settings, Access::kRead);
  SourceTable sources(map, zoom_of(settings.cell_m));
  if (!replace) refuse_other_content(map, sources, record);
}

std::vector<TileIndex> MapWriter::begin_source(const SourceRecord& record, std::span<const TileIndex> blocks,
                                               bool replace) {
  State& s = *state_;
  for (const TileIndex block : blocks) {
    if (on_lattice(block, s.tiles.finest_zoom())) continue;
    throw InvalidInput("block-outside-zone",
                       fmt::format("source '{}': block column {} row {} lies outside the UTM zone of the map. Choose "
                                   "the zone of the source, or cut the source",
                                   record.name, block.col, block.row));
  }
  Transaction transaction(s.map, Transaction::Kind::kWrite);
  if (!replace) refuse_other_content(s.map, s.sources, record);
  const auto in_force = s.sources.find(record.name, true);
  auto unfinished = s.sources.find(record.name, false);
  const bool same = in_force && in_force->fingerprint == record.fingerprint;
  const bool resumes = unfinished && unfinished->fingerprint == record.fingerprint;
  if (unfinished && !resumes) {
    s.sources.remove(unfinished->id);
    unfinished.reset();
  }
  std::vector<TileIndex> open;
  if (same) {
    if (unfinished) s.sources.remove(unfinished->id);
    s.sources.set_provenance(in_force->id, record);
    if (in_force->registration_sigma_m != record.provenance.registration_sigma_m) mark_shifts_outdated(s.map);
  } else {
    const std::int64_t id = unfinished ? unfinished->id : s.sources.insert(record);
    s.sources.set_provenance(id, record);
    s.sources.set_ledger(id, blocks);
    const auto done = s.sources.done_blocks(id);
    std::ranges::copy_if(blocks, std::back_inserter(open), [&](TileIndex block) { return !done.contains(block); });
  }
  transaction.commit();
  return open;
}

void MapWriter::put_blocks(const std::string& source, std::span<const FinishedBlock> blocks) {
  State& s = *state_;
  Transaction transaction(s.map, Transaction::Kind::kWrite);
  const auto unfinished = s.sources.find(source, false);
  for (const auto& [index, cells] : blocks) {
    if (unfinished && s.evidence.put(unfinished->id, index, cells)) continue;
    throw InvalidInput("block-not-expected", fmt::format("{}: source '{}' has not begun with block column {} row {}",
                                                         s.map.path().string(), source, index.col, index.row));
  }
  transaction.commit();
}

void MapWriter::finish_source(const std::string& source, const OnProgress& progress, std::stop_token stop) {
  State& s = *state_;
  {
    Transaction transaction(s.map, Transaction::Kind::kWrite);
    const auto replaced = s.sources.find(source, true);
    if (const auto complete = s.sources.find(source, false)) {
      s.sources.require_complete(complete->id, source);
      if (replaced) {
        remember_error_of_removed(s.map, replaced->id);
        s.fusion.add_source(replaced->id);
        s.sources.remove(replaced->id);
      }
      s.fusion.add_source(complete->id);
      s.sources.put_in_force(complete->id);
      mark_shifts_outdated(s.map);
    } else if (!replaced) {
      throw s.no_source(source);
    }
    transaction.commit();
  }
  s.fusion.drain(progress, stop);
}

std::vector<std::string> MapWriter::twins_of(const std::string& source) { return state_->evidence.twins_of(source); }

SharedEvidence MapWriter::shared_evidence(const std::string& source, std::span<const Witness> witnesses,
                                          std::int64_t count) {
  return state_->evidence.shared_evidence(source, witnesses, count);
}

std::vector<std::string> MapWriter::sources_sharing_ground(const std::string& source) {
  return state_->evidence.sources_sharing_ground(source);
}

std::set<std::string> MapWriter::sources_in_force() {
  std::set<std::string> names;
  for (auto& [id, name] : state_->sources.in_force()) names.insert(std::move(name));
  return names;
}

bool MapWriter::shifts_outdated() { return roadfix::shifts_outdated(state_->map); }

void MapWriter::put_shifts(const std::map<std::string, std::optional<SourceShift>>& shifts) {
  roadfix::put_shifts(state_->map, shifts);
}

void MapWriter::remove_if_new_and_empty() {
  State& s = *state_;
  if (!s.made_here || Statement(s.map, "SELECT 1 FROM roadfix_blocks WHERE done = 1").step()) return;
  std::error_code error;  // ignored: an earlier failure is being reported, and `verify` calls such a map empty
  std::filesystem::remove(s.map.path(), error);
}

bool MapWriter::remove_source(const std::string& source, const OnProgress& progress, std::stop_token stop) {
  State& s = *state_;
  bool any = false;
  {
    Transaction transaction(s.map, Transaction::Kind::kWrite);
    for (const bool in_force : {false, true}) {
      const auto found = s.sources.find(source, in_force);
      if (!found) continue;
      if (in_force) {
        remember_error_of_removed(s.map, found->id);
        s.fusion.add_source(found->id);
        mark_shifts_outdated(s.map);
      }
      s.sources.remove(found->id);
      any = true;
    }
    if (!any && s.fusion.size() == 0 && !shifts_outdated()) throw s.no_source(source);
    transaction.commit();
  }
  s.fusion.drain(progress, stop);
  return any;
}

std::vector<std::string> MapWriter::repair(const OnProgress& progress, std::stop_token stop) {
  State& s = *state_;
  Transaction transaction(s.map, Transaction::Kind::kWrite);
  std::vector<std::string> lost = s.evidence.drop_damaged();
  // All evidence in force is fused anew, so that nothing else has to wait.
  for (const char* sql : {"DELETE FROM roadfix_pending",
                          "DELETE FROM gpkg_2d_gridded_tile_ancillary WHERE tpudt_name = 'road_probability'",
                          "DELETE FROM road_probability"}) {
    s.map.execute(sql);
  }
  Statement(s.map, "UPDATE roadfix_meta SET value = ?1 WHERE key = 'version'").with(version_text(0)).run();
  for (const auto& [id, name] : s.sources.in_force()) s.fusion.add_source(id);
  if (!lost.empty()) mark_shifts_outdated(s.map);
  s.fusion.update_extent();
  transaction.commit();
  s.fusion.drain(progress, stop);
  return lost;
}

void MapWriter::put_terrain(const Terrain& terrain, const TerrainRecord& record) {
  Transaction transaction(state_->map, Transaction::Kind::kWrite);
  roadfix::put_terrain(state_->map, terrain, record);
  transaction.commit();
}

bool MapWriter::remove_terrain() {
  Transaction transaction(state_->map, Transaction::Kind::kWrite);
  const bool was_there = roadfix::remove_terrain(state_->map);
  transaction.commit();
  return was_there;
}

std::vector<std::string> MapWriter::repair_terrain() {
  Transaction transaction(state_->map, Transaction::Kind::kWrite);
  std::vector<std::string> damage = drop_damaged_terrain(state_->map);
  transaction.commit();
  return damage;
}

}  // namespace roadfix
