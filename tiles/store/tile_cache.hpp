// Decoded tiles, bounded in bytes; drops the least recently used. Also remembers which tiles are absent, which saves a
// query. Thread-safe.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "core/grid/cell_array.hpp"
#include "core/units/lru_cache.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {

class TileCache {
 public:
  struct Key {
    int level = 0;
    TileIndex tile;
    friend bool operator==(const Key&, const Key&) = default;
  };
  /// Null for a tile that the map does not have.
  using Tile = std::shared_ptr<const CellArray>;

  explicit TileCache(std::size_t capacity_bytes) : tiles_(capacity_bytes) {}

  /// The kept tile, or what `load` returns. It runs without a lock: two threads may load the same tile at once.
  template <typename Load>
  Tile get(const Key& key, const Load& load) {
    if (auto kept = tiles_.find(key)) return *std::move(kept);
    Tile tile = load();
    tiles_.insert(key, tile, cost(tile));
    return tile;
  }

  std::size_t bytes() const { return tiles_.bytes(); }

 private:
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  static std::size_t cost(const Tile& tile);

  LruCache<Key, Tile, Hash> tiles_;
};

}  // namespace roadfix
