// The bytes of a stored tile: a grey PNG of 256 x 256 cells, 8 bits for evidence, 16 bits for the fused map (the
// gridded coverage extension asks for 16: 0..254 = probability k / 254, 65535 = unobserved) and for heights.
//
// Encoding is deterministic: equal cells give equal bytes (for one version of libdeflate). The size is checked
// before a pixel is decompressed: a PNG bomb costs nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/cell_array.hpp"

namespace roadfix {

enum class TileDepth { kEvidence = 8, kFused = 16 };

/// `cells` must be 256 x 256.
std::vector<std::byte> encode_tile(const CellArray& cells, TileDepth depth);

/// Throws CorruptData ("tile-corrupt") for anything that encode_tile of that depth cannot have made: not a PNG,
/// damaged, cut off, another size or colour type, a value between 254 and unobserved. The message says what is wrong,
/// not where.
CellArray decode_tile(std::span<const std::byte> png, TileDepth depth);

/// The same for the codes of a Terrain, row by row; any value is one.
std::vector<std::byte> encode_heights(std::span<const std::uint16_t> codes);
std::vector<std::uint16_t> decode_heights(std::span<const std::byte> png);

}  // namespace roadfix
