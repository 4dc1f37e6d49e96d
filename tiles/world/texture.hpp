// Fine and coarse variation of surfaces, tied to the ground so that both pictures and all tiles agree.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace roadfix::world {

class Texture {
 public:
  explicit Texture(std::uint64_t seed);

  /// Multiplies the colours of a tile by what their materials vary. `pixels` places the tile in the picture.
  void apply(cv::Mat3b& colour, const cv::Mat1b& material, cv::Rect pixels, double gsd_m) const;

  /// White noise of mean 0 and deviation 1, a new one for each `shift`.
  float grain(int col, int row, int shift) const;
  /// Smooth, mean 0, deviation about 1, features of 4 to 60 m; position in half metres.
  float patches(int x, int y) const;

 private:
  cv::Mat1f grain_;
  cv::Mat1f patches_;
};

}  // namespace roadfix::world
