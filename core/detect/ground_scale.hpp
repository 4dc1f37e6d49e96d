// Pictures of the ground at another ground sample distance.
#pragma once

#include "core/detect/road_detector.hpp"

namespace roadfix {

/// The same ground at `gsd_m`; coarser pixels average what they cover, a pixel is observed where at least half of it
/// was.
GroundImage at_gsd(const GroundImage& image, double gsd_m);

/// CV_8UC1 brightness.
cv::Mat brightness_of(const cv::Mat& pixels);

}  // namespace roadfix
