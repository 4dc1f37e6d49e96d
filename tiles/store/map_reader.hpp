// Reads a map file (an OGC GeoPackage, see schema/map-format.md). Read-only; many readers may share a file with one
// writer.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/grid/road_grid.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

class MapReader {
 public:
  /// `cache_bytes` bounds the decoded tiles that are kept in memory. A writer locks the file at the end of a
  /// transaction, and from the middle of a large one on. This and all that reads waits for it as long as `patience`,
  /// then throws InUse ("map-busy").
  /// Throws NotFound ("map-not-found"), CorruptData ("map-empty-file", "map-cut-off", "map-corrupt"), InvalidInput
  /// ("map-not-ours", "map-from-newer-version", "map-from-older-version") or IoFailure.
  explicit MapReader(const std::filesystem::path& path, std::size_t cache_bytes = std::size_t{256} << 20,
                     std::chrono::milliseconds patience = sqlite::kPatience);
  ~MapReader();
  MapReader(MapReader&&) noexcept;
  MapReader& operator=(MapReader&&) noexcept;

  /// As it was when the map was opened. Tiles are read when they are asked for and kept. Once a writer has changed one,
  /// what is not kept throws InUse ("map-renewed"), until the map is as it was; a new reader has the map as it is
  /// then. Another file that takes the place of the map is never read: what needs a descriptor more than there are then
  /// throws that, too.
  const MapInfo& info() const;

  /// Fused cells; geometry.cell_m = settings.cell_m * 2^level with level >= 0, at most 4096 m (levels that the file
  /// does not hold are made from its coarsest). Unobserved where the map has none. Thread-safe. Throws InvalidInput
  /// ("cell-size-not-in-map") or CorruptData naming the tile.
  RoadGrid read(const GridGeometry& geometry) const;
  /// 0 <= level < info().levels, 0 is the finest. nullopt where the map has no such tile (nothing observed).
  std::optional<CellArray> tile(int level, TileIndex index) const;
  /// Row by row from the north-west.
  std::vector<TileIndex> tiles(int level) const;

  /// The largest registration error (1 sigma per axis; SourceStatus) of the sources in force that observed something on
  /// the tiles of a box, now; nullopt where none did. Thread-safe.
  std::optional<double> registration_sigma_m(const GridBox& box) const;

  std::size_t cached_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// nullopt where no file is.
std::optional<MapInfo> info_of(const std::filesystem::path& path);

/// What the map holds of the source of this name in force; nothing where no file or no such source is.
std::set<TileIndex> blocks_in_force(const std::filesystem::path& path, const std::string& source);

/// What the map holds of this very source, whole or interrupted: MapWriter::begin_source() would not ask for these
/// blocks.
std::set<TileIndex> finished_blocks(const std::filesystem::path& path, const SourceRecord& record);

}  // namespace roadfix
