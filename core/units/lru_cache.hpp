// Values by key, the least recently used first out, bounded in bytes. Thread-safe.
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

namespace roadfix {

template <typename Key, typename Value, typename Hash = std::hash<Key>>
class LruCache {
 public:
  explicit LruCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  std::optional<Value> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = places_.find(key);
    if (found == places_.end()) return std::nullopt;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->value;
  }

  /// `bytes`: of all that it takes. A key that is kept already keeps its value. What is larger than the whole cache is
  /// not kept, and what is in it stays.
  void insert(const Key& key, Value value, std::size_t bytes) {
    if (bytes > max_bytes_) return;
    const std::lock_guard lock(mutex_);
    if (places_.contains(key)) return;
    std::list<Entry> fresh;  // until nothing can fail any more
    fresh.push_front({key, std::move(value), bytes});
    places_.emplace(key, fresh.begin());
    entries_.splice(entries_.begin(), fresh);
    bytes_ += bytes;
    while (bytes_ > max_bytes_) {
      bytes_ -= entries_.back().bytes;
      places_.erase(entries_.back().key);
      entries_.pop_back();
    }
  }

  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

 private:
  struct Entry {
    Key key;
    Value value;
    std::size_t bytes = 0;
  };

  mutable std::mutex mutex_;
  const std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;  ///< most recently used first
  std::unordered_map<Key, typename std::list<Entry>::iterator, Hash> places_;
};

}  // namespace roadfix
