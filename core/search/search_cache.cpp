#include "core/search/search_cache.hpp"

#include <chrono>
#include <cmath>
#include <exception>

#include "core/units/fnv.hpp"

namespace roadfix {
namespace {

/// Whether it is ready before the deadline. Throws as Deadline::over().
template <typename T>
bool is_ready_before(const Deadline& deadline, const std::shared_future<T>& result) {
  constexpr std::chrono::milliseconds kBetweenLooks(10);
  while (result.wait_for(kBetweenLooks) != std::future_status::ready) {
    if (deadline.over()) return false;
  }
  return true;
}

}  // namespace

SearchCache::Key SearchCache::key_of(std::type_index type, const GridGeometry& window, const Parameters& parameters) {
  return {type,
          {std::llround(window.cell_m * 1e6), window.origin.col, window.origin.row, window.cols, window.rows,
           parameters[0], parameters[1], parameters[2]}};
}

std::size_t SearchCache::KeyHash::operator()(const Key& key) const {
  const auto& [type, numbers] = key;
  Fnv1a64 hash;
  hash.add({reinterpret_cast<const char*>(numbers.data()), sizeof(numbers)});
  return hash.value() ^ type.hash_code();
}

SearchCache::Pointer SearchCache::entry(const Key& key, const Deadline& deadline, const std::function<Value()>& build) {
  std::promise<Pointer> promise;
  std::shared_future<Pointer> result;
  {
    const std::lock_guard lock(mutex_);
    if (auto kept = kept_.find(key)) return *kept;
    const auto [found, is_new] = being_built_.try_emplace(key);
    if (is_new) {
      found->second = promise.get_future().share();
    } else {
      result = found->second;
    }
  }
  if (result.valid()) return is_ready_before(deadline, result) ? result.get() : nullptr;
  try {
    const Value built = build();
    const std::lock_guard lock(mutex_);
    kept_.insert(key, built.value, built.bytes);
    being_built_.erase(key);
    promise.set_value(built.value);
    return built.value;
  } catch (...) {
    const std::lock_guard lock(mutex_);
    being_built_.erase(key);
    promise.set_exception(std::current_exception());
    throw;
  }
}

}  // namespace roadfix
