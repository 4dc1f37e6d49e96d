// Plain PNG by libdeflate: a header, pixels, and the end. The tiles of a map are written so, pictures of them, and
// feature maps: a tile is unpacked in an eighth of the time that zlib takes, and packed in a fifth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/png/png_reader.hpp"

namespace roadfix {

/// Grey, grey and alpha, RGB or RGB and alpha: as many channels. `pixels` has shape.bytes(), 16 bits big-endian. Equal
/// pixels give equal bytes.
std::vector<std::byte> encode_plain_png(std::span<const std::uint8_t> pixels, const PngShape& shape);

/// Fills `pixels`, which has shape.bytes(), of one channel, and no more: a PNG that unpacks to more costs nothing.
/// False for what PngReader has to read, or to say what is wrong with it: another shape, more beside the pixels, rows
/// stored otherwise than as they are or as differences from the row above, and whatever is damaged. `pixels` may be
/// anything then.
bool read_plain_png(std::span<const std::byte> png, const PngShape& shape, std::span<std::uint8_t> pixels);

}  // namespace roadfix
