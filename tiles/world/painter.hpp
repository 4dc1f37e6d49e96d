// Paints a plan onto one tile: ground, streets, vegetation, buildings, rubble, then light and camera.
#pragma once

#include <opencv2/core.hpp>

#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"
#include "tiles/world/texture.hpp"

namespace roadfix::world {

/// The pixels of the tile, red, green, blue. Painted with a margin, so that neighbouring tiles fit without a seam; the
/// tile's corner must be a multiple of 8 pixels.
cv::Mat3b paint_tile(const Plan& plan, const Conditions& conditions, const Texture& texture, cv::Rect tile,
                     double gsd_m);

}  // namespace roadfix::world
