// Black or white borders that were painted around what a picture shows, and are marked by nothing: the wedges beside a
// turned or reprojected picture, the collar of an orthophoto, a letter box.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/detect/frame_image.hpp"

namespace roadfix {

/// Lossy codecs blur a border by so many levels where it meets the ground.
inline constexpr int kBorderTolerance = 8;

/// The squares in a picture's corners that tell its border's colour; none in a picture that they would fill.
std::vector<cv::Rect> corner_squares(cv::Size picture);

/// 0 or 255 where all pixels of a corner (CV_8UC1 or CV_8UC3) are pure black or white; nullopt elsewhere. A corner in
/// any other colour may be ground, of which a lossy codec left one level.
std::optional<std::uint8_t> painted_level(const cv::Mat& corner);

/// Of the areas that are 255 in `marked` (CV_8UC1) those that touch its rim, as 255; 0 elsewhere.
cv::Mat joined_to_rim(const cv::Mat& marked);

/// Marks as not observed what is connected to the picture's rim in the colour of a painted corner.
void exclude_painted_border(FramePixels& frame);

}  // namespace roadfix
