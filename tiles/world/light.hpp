// What happens to a painted tile on its way to the sensor: cast shadows, haze, blur, noise.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "tiles/world/conditions.hpp"
#include "tiles/world/plan.hpp"
#include "tiles/world/texture.hpp"

namespace roadfix::world {

/// 0 in the light .. 255 in the shadow of something higher towards the sun.
cv::Mat1b cast_shadows(const cv::Mat1f& height, double gsd_m, const Conditions& conditions);

/// Darkens shaded pixels; light of the sky leaves them bluish.
void shade(cv::Mat3b& colour, const cv::Mat1b& shadow);

/// Haze (thicker around debris), contrast, colour, blur and noise of the camera. `pixels` places the tile.
void expose(cv::Mat3b& colour, cv::Rect pixels, double gsd_m, const Conditions& conditions,
            const std::vector<Debris>& debris, const Texture& texture);

}  // namespace roadfix::world
