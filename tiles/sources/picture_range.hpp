// Which values of a picture of more than bytes become black and white.
#pragma once

#include <vector>

#include "tiles/sources/raster_file.hpp"

namespace roadfix {

/// Without the lowest or the highest value, where more pixels than ground would have exactly that (0.5 % or more): what
/// the rim of an image, or a hole in it, was filled with. -9999 and the like would otherwise take up the whole range.
std::vector<float> without_fill(std::vector<float> values);

/// From the 0.5th to the 99.5th percentile.
ValueRange percentile_range(std::vector<float> values);

}  // namespace roadfix
