// Bytes of a stored tile, as they are and with the checksums of their chunks put right, so that damage gets past these.
// What is accepted must be a tile that encodes and decodes to itself, and both readers must see the same in it.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/png/plain_png.hpp"
#include "core/png/png_chunk.hpp"
#include "core/units/error.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/tile_png.hpp"

namespace roadfix {
namespace {

std::string with_right_checksums(std::string_view bytes) {
  std::string png(bytes.substr(0, kPngSignature.size()));
  std::string_view rest = bytes.substr(png.size());
  while (const auto chunk = take_png_chunk(rest)) png += png_chunk(chunk->type, chunk->data);
  return png.append(rest);
}

void compare_readers(std::span<const std::byte> bytes, const PngShape& shape) {
  std::vector<std::uint8_t> pixels(shape.bytes());
  if (!read_plain_png(bytes, shape, pixels)) return;
  PngReader reader(bytes, PngOrigin::kOwn);
  std::vector<std::uint8_t> others(reader.shape().bytes());
  reader.read(others);
  if (others != pixels) std::abort();
}

void read_tile(std::span<const std::byte> bytes) {
  for (const TileDepth depth : {TileDepth::kEvidence, TileDepth::kFused}) {
    try {
      compare_readers(bytes, {kTileCells, kTileCells, 1, static_cast<int>(depth)});
      const CellArray cells = decode_tile(bytes, depth);
      if (decode_tile(encode_tile(cells, depth), depth) != cells) std::abort();
    } catch (const CorruptData&) {
      continue;
    }
  }
}

}  // namespace
}  // namespace roadfix

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roadfix::read_tile(std::as_bytes(std::span(data, size)));
  if (size < roadfix::kPngSignature.size()) return 0;
  const std::string png = roadfix::with_right_checksums({reinterpret_cast<const char*>(data), size});
  roadfix::read_tile(std::as_bytes(std::span(png)));
  return 0;
}
