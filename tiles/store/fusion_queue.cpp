#include "tiles/store/fusion_queue.hpp"

#include <fmt/format.h>

#include "core/units/error.hpp"
#include "core/units/parallel_for.hpp"
#include "tiles/store/map_description.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/tile_matrix.hpp"
#include "tiles/store/tile_png.hpp"

namespace roadfix {

using sqlite::Statement;
using sqlite::Transaction;

namespace {

/// Tiles fused in one transaction: few enough for readers not to wait long.
constexpr int kTilesPerTransaction = 64;

}  // namespace

void FusionQueue::add_source(std::int64_t id) {
  Statement(map_,
            "INSERT OR IGNORE INTO roadfix_pending SELECT ?2, tile_row, tile_column FROM roadfix_evidence WHERE "
            "source_id = ?1")
      .with(id, tiles_.finest_zoom())
      .run();
  Statement parents(map_,
                    "INSERT OR IGNORE INTO roadfix_pending SELECT ?1, tile_row >> 1, tile_column >> 1 FROM "
                    "roadfix_pending WHERE zoom_level = ?1 + 1");
  for (int zoom = tiles_.finest_zoom() - 1; zoom >= kCoarsestZoom; --zoom) parents.with(zoom).run();
}

std::int64_t FusionQueue::size() { return count_pending(map_); }

/// The tile as it is stored; empty where nothing was observed.
std::vector<std::byte> FusionQueue::fused(Tile tile) {
  const auto [zoom, index] = tile;
  const auto cells = tiles_.derived(zoom, index);
  if (!cells || !cells->any_observed()) return {};
  return encode_tile(*cells, TileDepth::kFused);
}

/// Tiles of one level, on all processors: most of the work is their compression.
void FusionQueue::fuse(std::span<const Tile> tiles) {
  std::vector<std::vector<std::byte>> pngs(tiles.size());
  parallel_for(static_cast<int>(tiles.size()), processors(), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    pngs[at] = fused(tiles[at]);
  });
  Statement done(map_, "DELETE FROM roadfix_pending WHERE zoom_level = ?1 AND tile_row = ?2 AND tile_column = ?3");
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto [zoom, index] = tiles[i];
    tiles_.put(zoom, index, pngs[i]);
    done.with(zoom, tile_row(index, zoom), index.col).run();
  }
}

FusionQueue::Tile FusionQueue::pending_tile(const Statement& row) const {
  if (!in_pyramid(row.integer(0), row.integer(1), row.integer(2), tiles_.finest_zoom())) {
    throw CorruptData("map-corrupt", fmt::format("{}: roadfix_pending names a tile outside the lattice. {}",
                                                 map_.path().string(), kRepair));
  }
  const int zoom = static_cast<int>(row.integer(0));
  return {zoom, {static_cast<int>(row.integer(2)), index_row(static_cast<int>(row.integer(1)), zoom)}};
}

/// Fuses the next tiles of the finest level that has any waiting (overviews are made from the level below) in one
/// transaction. Returns how many.
std::int64_t FusionQueue::fuse_some() {
  Transaction transaction(map_, Transaction::Kind::kWrite);
  Statement next(map_,
                 "SELECT zoom_level, tile_row, tile_column FROM roadfix_pending WHERE zoom_level = (SELECT "
                 "max(zoom_level) FROM roadfix_pending) ORDER BY tile_row, tile_column LIMIT ?1");
  std::vector<Tile> batch;
  next.with(kTilesPerTransaction);
  while (next.step()) batch.push_back(pending_tile(next));
  fuse(batch);
  const bool last = sqlite::number(map_, "SELECT NOT EXISTS (SELECT 1 FROM roadfix_pending)") == 1;
  if (last && !batch.empty()) update_extent();
  transaction.commit();
  return static_cast<std::int64_t>(batch.size());
}

void FusionQueue::update_extent() {
  const GridBox box = tiles_.observed_extent();
  const std::string update = fmt::format(
      "UPDATE gpkg_contents SET last_change = {}, min_x = ?1, min_y = ?2, max_x = ?3, max_y = ?4 WHERE table_name = "
      "'road_probability'",
      kSqlNow);
  if (box.empty()) {
    Statement(map_, update).run();
  } else {
    Statement(map_, update).with(box.min.east_m, box.min.north_m, box.max.east_m, box.max.north_m).run();
  }
}

void FusionQueue::drain(const OnProgress& progress, const std::stop_token& stop) {
  const std::int64_t total = size();
  std::int64_t done = 0;
  if (progress) progress(done, total);
  while (done < total) {
    if (stop.stop_requested()) {
      throw Interrupted("work-stopped",
                        fmt::format("{}: stopped with {} of {} tiles fused. Repeat the command to go on",
                                    map_.path().string(), done, total));
    }
    done += fuse_some();
    if (progress) progress(done, total);
  }
}

}  // namespace roadfix
