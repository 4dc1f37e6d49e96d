// A picture as a sketch that tells it from others: see core/grid/picture_sketch.hpp.
#pragma once

#include <opencv2/core.hpp>

#include "core/grid/picture_sketch.hpp"

namespace roadfix {

/// `pixels`: 8 bits, grey or BGR, at least one.
PictureSketch sketch_of(const cv::Mat& pixels);

}  // namespace roadfix
