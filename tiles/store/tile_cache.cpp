#include "tiles/store/tile_cache.hpp"

#include <cstdint>

#include "core/units/splitmix.hpp"

namespace roadfix {
namespace {

/// List node, map node and control block, roughly.
constexpr std::size_t kEntryBytes = 192;

}  // namespace

std::size_t TileCache::Hash::operator()(const Key& key) const {
  const auto place = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.tile.col)) << 32 |
                     static_cast<std::uint32_t>(key.tile.row);
  return mix64(place + static_cast<std::uint64_t>(key.level) * kGoldenGamma);
}

std::size_t TileCache::cost(const Tile& tile) {
  return kEntryBytes + (tile == nullptr ? 0 : tile->cells().size_bytes());
}

std::size_t TileCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

bool TileCache::find(const Key& key, Tile& tile) {
  const std::lock_guard lock(mutex_);
  const auto found = index_.find(key);
  if (found == index_.end()) return false;
  entries_.splice(entries_.begin(), entries_, found->second);
  tile = found->second->tile;
  return true;
}

void TileCache::keep(const Key& key, const Tile& tile) {
  const std::lock_guard lock(mutex_);
  if (index_.contains(key)) return;
  entries_.push_front({key, tile});
  index_.emplace(key, entries_.begin());
  bytes_ += cost(tile);
  while (bytes_ > capacity_ && !entries_.empty()) {
    bytes_ -= cost(entries_.back().tile);
    index_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

}  // namespace roadfix
