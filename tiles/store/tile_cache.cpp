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

}  // namespace roadfix
