#include "core/search/search_cache.hpp"

#include <cmath>

namespace roadfix {

std::size_t SearchCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

SearchCache::Key SearchCache::key_of(std::size_t kind, const GridGeometry& window, const Parameters& parameters) {
  return {static_cast<std::int64_t>(kind),
          std::llround(window.cell_m * 1e6),
          window.origin.col,
          window.origin.row,
          window.cols,
          window.rows,
          parameters[0],
          parameters[1],
          parameters[2]};
}

std::shared_ptr<const void> SearchCache::entry(const Key& key, const std::function<Value()>& build) {
  std::promise<Value> promise;
  std::shared_future<Value> value;
  bool builds = false;
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_[key];
    entry.asked = ++asked_;
    builds = !entry.value.valid();
    if (builds) entry.value = promise.get_future().share();
    value = entry.value;
  }
  if (!builds) return value.get().value;
  try {
    promise.set_value(build());
    keep(key, value.get().bytes);
  } catch (...) {
    {
      const std::lock_guard lock(mutex_);
      entries_.erase(key);
    }
    promise.set_exception(std::current_exception());
  }
  return value.get().value;
}

void SearchCache::keep(const Key& key, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  entries_.at(key).bytes = bytes;
  bytes_ += bytes;
  while (bytes_ > max_bytes_) {
    auto oldest = entries_.end();
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
      if (entry->second.bytes > 0 && (oldest == entries_.end() || entry->second.asked < oldest->second.asked))
        oldest = entry;
    }
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
  }
}

}  // namespace roadfix
