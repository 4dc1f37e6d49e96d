// Decoded tiles, least recently used first out, bounded in bytes. Knows absent tiles too, so that asking for one again
// costs no query. Thread-safe.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "core/grid/cell_array.hpp"
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

  explicit TileCache(std::size_t capacity_bytes) : capacity_(capacity_bytes) {}

  /// The kept tile, or what `load` returns. It runs without a lock: two threads may load the same tile at once.
  template <typename Load>
  Tile get(const Key& key, const Load& load) {
    Tile tile;
    if (find(key, tile)) return tile;
    tile = load();
    keep(key, tile);
    return tile;
  }

  std::size_t bytes() const;

 private:
  struct Entry {
    Key key;
    Tile tile;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  bool find(const Key& key, Tile& tile);
  void keep(const Key& key, const Tile& tile);
  static std::size_t cost(const Tile& tile);

  mutable std::mutex mutex_;
  const std::size_t capacity_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;  ///< most recently used first
  std::unordered_map<Key, std::list<Entry>::iterator, Hash> index_;
};

}  // namespace roadfix
