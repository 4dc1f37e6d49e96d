// The fused tiles of a map file and what has to change with them: ancillary rows, version, extent.
// Shared by writer and verifier; not for other modules.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/units/planar.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

class TileTable {
 public:
  TileTable(sqlite::Connection& map, const MapSettings& settings);

  int finest_zoom() const { return finest_; }

  /// Stores a tile as encode_tile() makes it; where it is empty, none is there. Keeps ancillary row and version right;
  /// an equal tile is left as it is.
  void put(int zoom, TileIndex index, std::span<const std::byte> png);

  /// Box of the observed cells of the finest level; empty() when there is none.
  GridBox observed_extent();

  // Those that follow may be called from several threads at once, while nothing is put.

  /// nullopt where there is none. Throws CorruptData naming the tile.
  std::optional<CellArray> tile(int zoom, TileIndex index);
  /// What the tile should be: of the finest level what the evidence in force says, above it what the four tiles below
  /// do. nullopt where there are none. Throws CorruptData naming the evidence or the tile below.
  std::optional<CellArray> derived(int zoom, TileIndex index);

 private:
  std::optional<CellArray> fused_evidence(TileIndex index);
  std::optional<CellArray> overview(int zoom, TileIndex index);
  void add_to_version(std::uint64_t difference);

  sqlite::Connection& map_;
  double cell_m_;
  int finest_;
  std::mutex mutex_;  ///< of select_ and evidence_
  sqlite::Statement select_;
  sqlite::Statement update_;
  sqlite::Statement insert_;
  sqlite::Statement insert_ancillary_;
  sqlite::Statement remove_ancillary_;
  sqlite::Statement remove_;
  sqlite::Statement evidence_;
  sqlite::Statement set_version_;
};

}  // namespace roadfix
