// Bytes of a stored tile. What is accepted must be a tile that encodes and decodes to itself.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "core/units/error.hpp"
#include "tiles/store/tile_png.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  for (const auto depth : {roadfix::TileDepth::kEvidence, roadfix::TileDepth::kFused}) {
    try {
      const roadfix::CellArray cells = roadfix::decode_tile(bytes, depth);
      if (roadfix::decode_tile(roadfix::encode_tile(cells, depth), depth) != cells) std::abort();
    } catch (const roadfix::CorruptData&) {
      continue;
    }
  }
  return 0;
}
