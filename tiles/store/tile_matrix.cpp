#include "tiles/store/tile_matrix.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace roadfix {
namespace {

/// Finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection that spreads every bit.
constexpr std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

}  // namespace

int zoom_of(double cell_m) {
  const int zoom = 12 - std::ilogb(cell_m);
  assert(cell_of_zoom(zoom) == cell_m);
  return zoom;
}

std::uint64_t content_hash(TileIndex tile, std::span<const std::byte> png) {
  const auto col = static_cast<std::uint64_t>(static_cast<std::uint32_t>(tile.col));
  const auto row = static_cast<std::uint64_t>(static_cast<std::uint32_t>(tile.row));
  std::uint64_t hash = mixed((col << 32 | row) + 0x9e3779b97f4a7c15U);
  for (std::size_t i = 0; i < png.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, &png[i], std::min(sizeof word, png.size() - i));
    hash = mixed(hash ^ word);
  }
  return mixed(hash ^ png.size());
}

}  // namespace roadfix
