#include "tiles/mercator/tile_painting.hpp"

#include <algorithm>

#include "core/png/plain_png.hpp"

namespace roadfix::mercator {
namespace {

std::vector<std::byte> encoded(const std::vector<Pixel>& picture) {
  const bool is_grey =
      std::ranges::all_of(picture, [](const Pixel& pixel) { return pixel[0] == pixel[1] && pixel[1] == pixel[2]; });
  const int channels = is_grey ? 2 : 4;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.size() * static_cast<std::size_t>(channels));
  for (const Pixel& pixel : picture) bytes.insert(bytes.end(), pixel.end() - channels, pixel.end());
  return encode_plain_png(bytes, {kTilePixels, kTilePixels, channels, 8});
}

}  // namespace

Pixel grey_pixel(double value) {
  const auto grey = static_cast<std::uint8_t>(value + 0.5);
  return {grey, grey, grey, 255};
}

std::optional<std::vector<std::byte>> painted_tile(const PixelToGrid& ground, const PixelBox& box,
                                                   const std::function<std::optional<Pixel>(GridPoint)>& pixel_at) {
  std::vector<Pixel> picture(std::size_t{kTilePixels} * kTilePixels);
  bool any = false;
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const auto pixel = pixel_at(ground.at(x, y));
      if (!pixel) continue;
      picture[static_cast<std::size_t>(y * kTilePixels + x)] = *pixel;
      any = true;
    }
  }
  return any ? std::optional(encoded(picture)) : std::nullopt;
}

}  // namespace roadfix::mercator
