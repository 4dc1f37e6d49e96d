// Black or white borders that were painted around a picture and that nothing marks as such: the wedges of a turned or
// reprojected picture, the collar of an orthophoto, a letter box.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/detect/frame_image.hpp"

namespace roadfix {

/// Lossy codecs blur a border by so many levels where it meets the ground.
inline constexpr int kBorderTolerance = 8;

/// The squares in a picture's corners that show the border's colour; none if they would fill the picture.
std::vector<cv::Rect> corner_squares(cv::Size picture);

/// 0 or 255 if all pixels of a corner (CV_8UC1 or CV_8UC3) are black or white; else nullopt. A corner in any other
/// single colour may be ground that a lossy codec flattened.
std::optional<std::uint8_t> painted_level(const cv::Mat& corner);

/// The areas that are 255 in `marked` (CV_8UC1) and touch its rim, as 255; 0 elsewhere.
cv::Mat joined_to_rim(const cv::Mat& marked);

/// Marks as not observed all that is connected to the picture's rim in the colour of a painted corner.
void exclude_painted_border(FramePixels& frame);

}  // namespace roadfix
