// Rendered tiles, least recently used first out, bounded in bytes. A key that holds the map's version never goes stale.
#pragma once

#include <optional>
#include <string>

#include "core/units/lru_cache.hpp"

namespace roadfix::server {

class PictureCache {
 public:
  explicit PictureCache(std::size_t capacity_bytes) : pictures_(capacity_bytes) {}

  /// Empty bytes stand for a tile that shows nothing; nullopt for one that is not kept.
  std::optional<std::string> find(const std::string& key) { return pictures_.find(key); }
  void insert(const std::string& key, const std::string& bytes) {
    pictures_.insert(key, bytes, 2 * key.size() + bytes.size() + kEntryBytes);
  }
  std::size_t bytes() const { return pictures_.bytes(); }

 private:
  static constexpr std::size_t kEntryBytes = 128;
  LruCache<std::string, std::string> pictures_;
};

}  // namespace roadfix::server
