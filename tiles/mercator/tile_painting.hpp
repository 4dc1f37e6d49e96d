// The pixels of a tile's picture, whatever it shows.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "tiles/mercator/tile_ground.hpp"

namespace roadfix::mercator {

/// Red, green, blue and alpha.
using Pixel = std::array<std::uint8_t, 4>;

/// Opaque; `value` within 0..255 is rounded.
Pixel grey_pixel(double value);

/// PNG of 256 x 256 pixels, those of the box as `pixel_at` says, all others and where it says nothing transparent;
/// nullopt where nothing is to be seen. Of grey pixels only it is a grey one, with alpha.
std::optional<std::vector<std::byte>> painted_tile(const PixelToGrid& ground, const PixelBox& box,
                                                   const std::function<std::optional<Pixel>(GridPoint)>& pixel_at);

}  // namespace roadfix::mercator
