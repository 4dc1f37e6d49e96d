// The pixels of a tile's picture, whatever it shows.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "server/api/tile_ground.hpp"

namespace roadfix::api {

/// Blue, green, red and alpha.
using Pixel = cv::Vec4b;

/// Grey = `share` of 1, opaque.
Pixel grey_pixel(double share);

/// PNG of 256 x 256 pixels, those of the box as `pixel_at` says, all others and where it says nothing transparent;
/// nullopt where nothing is to be seen.
std::optional<std::vector<std::uint8_t>> painted_tile(const PixelToGrid& ground, const PixelBox& box,
                                                      const std::function<std::optional<Pixel>(GridPoint)>& pixel_at);

}  // namespace roadfix::api
