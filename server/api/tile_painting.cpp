#include "server/api/tile_painting.hpp"

#include <cmath>
#include <opencv2/imgcodecs.hpp>

namespace roadfix::api {

Pixel grey_pixel(double share) {
  const auto grey = static_cast<unsigned char>(std::lround(255.0 * share));
  return {grey, grey, grey, 255};
}

std::optional<std::vector<std::uint8_t>> painted_tile(const PixelToGrid& ground, const PixelBox& box,
                                                      const std::function<std::optional<Pixel>(GridPoint)>& pixel_at) {
  cv::Mat picture(kTilePixels, kTilePixels, CV_8UC4, cv::Scalar::all(0));
  bool any = false;
  for (int y = box.top; y < box.bottom; ++y) {
    auto* const row = picture.ptr<Pixel>(y);
    for (int x = box.left; x < box.right; ++x) {
      const auto pixel = pixel_at(ground.at(x, y));
      if (!pixel) continue;
      row[x] = *pixel;
      any = true;
    }
  }
  if (!any) return std::nullopt;
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png, {cv::IMWRITE_PNG_COMPRESSION, 1});
  return png;
}

}  // namespace roadfix::api
