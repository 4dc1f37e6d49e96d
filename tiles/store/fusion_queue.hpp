// The tiles of a map that do not yet follow from the evidence in force (table roadfix_pending), and the work of fusing
// them. For the writer; not for other modules.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/units/progress.hpp"
#include "tiles/store/sqlite.hpp"
#include "tiles/store/tile_table.hpp"

namespace roadfix {

class FusionQueue {
 public:
  FusionQueue(sqlite::Connection& map, TileTable& tiles) : map_(map), tiles_(tiles) {}

  /// Every tile that the evidence of the source touches, with its overviews, waits to be fused anew. Part of the
  /// caller's transaction.
  void add_source(std::int64_t id);
  /// Fuses what waits, finest level first, a few tiles per transaction, and then updates the extent.
  /// Throws Interrupted; what was done stays done.
  void drain(const OnProgress& progress, const std::stop_token& stop);
  /// The box of the observed cells, as other programs read it.
  void update_extent();
  /// Tiles of all levels that wait.
  std::int64_t size();

 private:
  using Tile = std::pair<int, TileIndex>;  ///< zoom and place

  Tile pending_tile(const sqlite::Statement& row) const;
  std::int64_t fuse_some();
  void fuse(std::span<const Tile> tiles);
  std::vector<std::byte> fused(Tile tile);

  sqlite::Connection& map_;
  TileTable& tiles_;
};

}  // namespace roadfix
