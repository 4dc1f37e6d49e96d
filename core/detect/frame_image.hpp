// The pixels of a decoded frame, and which of them were seen.
#pragma once

#include <opencv2/core.hpp>

namespace roadfix {

/// As in a GroundImage, but of whatever view of the ground.
struct FramePixels {
  cv::Mat pixels;
  cv::Mat observed;
};

enum class Border {
  kSeen,        ///< every pixel counts, unless an alpha channel says otherwise
  kBlackUnseen  ///< black areas that reach the picture's rim were not seen, as in frames rectified to the ground
};

/// `decoded` has 8 or 16 bits and 1, 3 or 4 channels (BGR order, alpha below one half = not seen). 16 bits become 8
/// from the 0.5th to the 99.5th percentile of what was seen, and black is 0 in them (at most 4 in 8 bits, which lossy
/// codecs blur). InvalidInput "image-shape" for anything else.
/// Moved in, it takes memory no longer than it has to.
FramePixels frame_image(cv::Mat decoded, Border border = Border::kSeen);

}  // namespace roadfix
