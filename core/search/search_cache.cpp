#include "core/search/search_cache.hpp"

#include <cmath>
#include <utility>

namespace roadfix {

std::size_t SearchCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

SearchCache::Key SearchCache::key_of(std::type_index type, const GridGeometry& window, const Parameters& parameters) {
  return {type,
          {std::llround(window.cell_m * 1e6), window.origin.col, window.origin.row, window.cols, window.rows,
           parameters[0], parameters[1], parameters[2]}};
}

std::shared_ptr<const void> SearchCache::entry(const Key& key, const std::function<Value()>& build) {
  std::promise<Value> promise;
  std::shared_future<Value> value = promise.get_future().share();
  Keys fresh{key};
  Entry* builds = nullptr;
  {
    const std::lock_guard lock(mutex_);
    const auto [found, is_new] = entries_.try_emplace(key, Entry{value, fresh.begin()});
    Entry& entry = found->second;
    if (is_new) {
      being_built_.splice(being_built_.begin(), fresh);
      builds = &entry;
    } else {
      if (entry.kept) kept_.splice(kept_.begin(), kept_, entry.place);
      value = entry.value;
    }
  }
  if (builds == nullptr) return value.get().value;
  try {
    Value built = build();
    keep(*builds, built.bytes);
    promise.set_value(std::move(built));
  } catch (...) {
    forget(key);
    promise.set_exception(std::current_exception());
  }
  return value.get().value;
}

void SearchCache::keep(Entry& entry, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  kept_.splice(kept_.begin(), being_built_, entry.place);
  entry.kept = true;
  entry.bytes = bytes;
  bytes_ += bytes;
  while (bytes_ > max_bytes_) {
    const auto oldest = entries_.find(kept_.back());
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
    kept_.pop_back();
  }
}

void SearchCache::forget(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(key);
  being_built_.erase(found->second.place);
  entries_.erase(found);
}

}  // namespace roadfix
