// A decoded frame as a picture of the ground: which of its pixels were seen.
#pragma once

#include "core/detect/road_detector.hpp"

namespace roadfix {

enum class Border {
  kSeen,        ///< every pixel counts, unless an alpha channel says otherwise
  kBlackUnseen  ///< black areas that reach the picture's rim were not seen, as in frames rectified to the ground
};

/// `decoded` has 8 or 16 bits and 1, 3 or 4 channels (BGR order, alpha below one half = not seen); 16 bits are cut
/// to their upper 8. InvalidInput "image-shape" for anything else.
GroundImage frame_image(const cv::Mat& decoded, double gsd_m, Border border = Border::kSeen);

/// CV_8UC1, 255 = seen: without the areas of pixels of at most `darkest` in each channel that touch the rim.
cv::Mat seen_inside_black_border(const cv::Mat& pixels, int darkest = 4);

}  // namespace roadfix
