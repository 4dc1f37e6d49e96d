#include "tiles/store/tile_matrix.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "core/units/splitmix.hpp"

namespace roadfix {

int zoom_of(double cell_m) {
  const int zoom = 12 - std::ilogb(cell_m);
  assert(cell_of_zoom(zoom) == cell_m);
  return zoom;
}

std::uint64_t content_hash(TileIndex tile, std::span<const std::byte> png) {
  const auto col = static_cast<std::uint64_t>(static_cast<std::uint32_t>(tile.col));
  const auto row = static_cast<std::uint64_t>(static_cast<std::uint32_t>(tile.row));
  std::uint64_t hash = SplitMix64(col << 32 | row).next();
  for (std::size_t i = 0; i < png.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, &png[i], std::min(sizeof word, png.size() - i));
    hash = mix64(hash ^ word);
  }
  return mix64(hash ^ png.size());
}

}  // namespace roadfix
