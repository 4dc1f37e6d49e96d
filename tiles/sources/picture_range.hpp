// Which values of a picture of more than bytes become black and white.
#pragma once

#include <optional>
#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// The lowest or the highest value, where more pixels than ground would have exactly that: what the rim of an image, or
/// a hole in it, was filled with. -9999 and the like would otherwise take up the whole range.
struct Fill {
  float value = 0.0F;
  bool lowest = false;
  double share = 0.0;
};

/// The more frequent one of the two ends of the values, if it has a share of 0.5 % or more and the rest differ.
std::optional<Fill> fill_of(const std::vector<float>& values);
std::vector<float> without_fill(std::vector<float> values);

/// From the 0.5th to the 99.5th percentile.
ValueRange percentile_range(std::vector<float> values);

}  // namespace roadfix
