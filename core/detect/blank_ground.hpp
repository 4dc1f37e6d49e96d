// Areas without any contrast, which count as not seen even if the picture calls them observed.
//
// No sensor sees 16 m of ground in one colour. Such areas are painted (the collar of an orthophoto, the border of a
// rectified frame), saturated, or drawn by the maker of a base map. A detector would have to guess there, and its guess
// would count as evidence.
#pragma once

#include "core/detect/road_detector.hpp"

namespace roadfix {

/// Side of the squares in which seen ground always varies; at least 16 pixels.
inline constexpr double kBlankSideM = 16.0;

/// Marks squares of that side as not observed if at least half of their pixels were observed and no channel varies by
/// more than one level, together with a quarter of a side around them, which codecs blur. Squares are tried at
/// multiples of a quarter of a side.
void exclude_blank(GroundImage& image);
/// Only squares in which something of the part lies.
void exclude_blank(GroundImage& image, const cv::Rect& part);

}  // namespace roadfix
