// Which values of a picture of more than bytes become black and white.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

/// Values of any number of images in bounded memory: of too many every second one is kept, every fourth, and so on.
class ThinnedValues {
 public:
  explicit ThinnedValues(std::size_t most = std::size_t{1} << 26U) : most_(most) {}

  void add(const std::vector<float>& values);
  bool empty() const { return kept_.empty(); }
  std::vector<float> take() && { return std::move(kept_); }

 private:
  std::size_t most_;
  std::size_t step_ = 1;  ///< from one that is kept to the next
  std::size_t skip_ = 0;  ///< values to come before the next that is kept
  std::vector<float> kept_;
};

/// Without the lowest or the highest value, where more pixels than ground would have exactly that (0.5 % or more): what
/// the rim of an image, or a hole in it, was filled with. -9999 and the like would otherwise take up the whole range.
std::vector<float> without_fill(std::vector<float> values);

/// From the 0.5th to the 99.5th percentile.
ValueRange percentile_range(std::vector<float> values);

}  // namespace roadfix
