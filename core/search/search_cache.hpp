// What a search builds of a part of a map before it can begin, kept for the next search of the same part.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <typeindex>
#include <typeinfo>
#include <utility>

#include "core/grid/geometry.hpp"
#include "core/match/deadline.hpp"
#include "core/units/lru_cache.hpp"

namespace roadfix {

/// Belongs to one version of one map. Holds at most so many bytes, and gives up first what was not asked for the
/// longest. Thread-safe: what several searches want at once is built once.
class SearchCache {
 public:
  /// What beside the window tells two things of one type apart.
  using Parameters = std::array<int, 3>;

  explicit SearchCache(std::size_t max_bytes) : kept_(max_bytes) {}

  /// What was built for `window` with these parameters before, or what build() returns now; T has bytes(). Where
  /// another search is building it, waits for that until the deadline, which may throw; nullptr = it was not ready by
  /// then.
  template <typename T, typename Build>
  std::shared_ptr<const T> get(const GridGeometry& window, const Parameters& parameters, const Deadline& deadline,
                               Build build) {
    const auto build_entry = [&] {
      auto value = std::make_shared<const T>(build());
      return Value{value, value->bytes()};
    };
    const auto built = entry(key_of(typeid(T), window, parameters), deadline, build_entry);
    return std::static_pointer_cast<const T>(built);
  }

  std::size_t bytes() const { return kept_.bytes(); }

 private:
  using Key = std::pair<std::type_index, std::array<std::int64_t, 8>>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  using Pointer = std::shared_ptr<const void>;
  struct Value {
    Pointer value;
    std::size_t bytes = 0;
  };

  static Key key_of(std::type_index type, const GridGeometry& window, const Parameters& parameters);
  Pointer entry(const Key& key, const Deadline& deadline, const std::function<Value()>& build);

  LruCache<Key, Pointer, KeyHash> kept_;
  std::mutex mutex_;  ///< of what is being built, and so that it is kept once it is no longer
  std::map<Key, std::shared_future<Pointer>> being_built_;
};

/// From the cache, or without one just built. nullptr as from SearchCache::get().
template <typename T, typename Build>
std::shared_ptr<const T> get_or_build(const std::shared_ptr<SearchCache>& cache, const GridGeometry& window,
                                      const SearchCache::Parameters& parameters, const Deadline& deadline,
                                      Build build) {
  if (!cache) return std::make_shared<const T>(build());
  return cache->get<T>(window, parameters, deadline, build);
}

}  // namespace roadfix
