// Rendered tiles, least recently used first out, bounded in bytes. A key that holds the map's version never goes stale.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

namespace roadfix::server {

class PictureCache {
 public:
  explicit PictureCache(std::size_t capacity_bytes) : capacity_(capacity_bytes) {}

  /// Empty bytes stand for a tile that shows nothing; nullopt for one that is not kept.
  std::optional<std::string> find(const std::string& key);
  void keep(const std::string& key, const std::string& bytes);
  std::size_t bytes() const;

 private:
  struct Entry {
    std::string key;
    std::string bytes;
  };
  static std::size_t cost(const Entry& entry) { return 2 * entry.key.size() + entry.bytes.size() + 128; }

  mutable std::mutex mutex_;
  const std::size_t capacity_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;  ///< most recently used first
  std::unordered_map<std::string, std::list<Entry>::iterator> index_;
};

}  // namespace roadfix::server
