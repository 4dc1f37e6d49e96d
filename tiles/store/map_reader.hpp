// Reads a map file (an OGC GeoPackage, see schema/map-format.md). Read-only; many readers may share a file with one
// writer.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/grid/road_grid.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {

class MapReader {
 public:
  /// `cache_bytes` bounds the decoded tiles that are kept in memory.
  /// Throws NotFound, CorruptData (cut off, corrupt) or InvalidInput ("map-not-ours", "map-from-newer-version").
  explicit MapReader(const std::filesystem::path& path, std::size_t cache_bytes = std::size_t{256} << 20);
  ~MapReader();
  MapReader(MapReader&&) noexcept;
  MapReader& operator=(MapReader&&) noexcept;

  const MapInfo& info() const;
  /// Fused cells; geometry.cell_m = settings.cell_m * 2^level, 0 <= level < levels (coarser ones are made from the
  /// last). Unobserved where the map has none. Thread-safe. Throws CorruptData naming the tile.
  RoadGrid read(const GridGeometry& geometry) const;
  /// nullopt where the map has no such tile.
  std::optional<CellArray> tile(int level, TileIndex index) const;
  std::vector<TileIndex> tiles(int level) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadfix
