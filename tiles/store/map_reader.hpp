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
  /// `cache_bytes` bounds the decoded tiles that are kept in memory. A writer locks the file at the end of its
  /// transactions, of large ones earlier. This and all methods that read wait for it as long as `patience`, then throw
  /// InUse ("map-busy").
  /// Throws NotFound ("map-not-found"), CorruptData ("map-empty-file", "map-cut-off", "map-corrupt"), InvalidInput
  /// ("map-not-ours", "map-from-newer-version", "map-from-older-version") or IoFailure.
  explicit MapReader(const std::filesystem::path& path, std::size_t cache_bytes = std::size_t{256} << 20,
                     std::chrono::milliseconds patience = sqlite::kPatience);
  ~MapReader();
  MapReader(MapReader&&) noexcept;
  MapReader& operator=(MapReader&&) noexcept;

  /// As it was when the map was opened. A reader never mixes versions: once a writer has changed tiles, all that is not
  /// in the cache throws InUse ("map-renewed"), and a new reader has to be made; so it is where another map is copied
  /// into the file (CorruptData while that lasts). Nor does it read another file that took the map's place: calls that
  /// would have to open it throw that, too.
  const MapInfo& info() const;

  /// Fused cells, unobserved where the map has none. geometry.cell_m = settings.cell_m * 2^level with level >= 0, at
  /// most 4096 m; levels that the file does not hold are made from its coarsest. Thread-safe. Throws InvalidInput
  /// ("cell-size-not-in-map") or CorruptData naming the tile.
  RoadGrid read(const GridGeometry& geometry) const;
  /// 0 <= level < info().levels, 0 is the finest. nullopt where the map has no such tile (nothing observed).
  std::optional<CellArray> tile(int level, TileIndex index) const;
  /// Row by row from the north-west.
  std::vector<TileIndex> tiles(int level) const;

  /// The largest registration error (1 sigma per axis; SourceStatus) of the sources in force that have evidence on the
  /// tiles of the box; nullopt if none has. Thread-safe.
  std::optional<double> registration_sigma_m(const GridBox& box) const;

  std::size_t cached_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// nullopt where no file is.
std::optional<MapInfo> info_of(const std::filesystem::path& path);

/// The blocks of the source of this name in force; none if there is no such file or source.
std::set<TileIndex> blocks_in_force(const std::filesystem::path& path, const std::string& source);

/// The blocks done of the source with this name and fingerprint, complete or not: those that
/// MapWriter::begin_source() would not ask for.
std::set<TileIndex> finished_blocks(const std::filesystem::path& path, const SourceRecord& record);

}  // namespace roadfix
