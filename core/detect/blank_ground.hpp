// Ground that a picture does not show, whatever it says of itself: areas without any contrast.
//
// No sensor sees 16 m of ground in one colour. Such areas are painted (the collar of an orthophoto, the border of a
// rectified frame), saturated, or drawn by the maker of a base map. A detector would have to guess there, and its guess
// would count as evidence.
#pragma once

#include "core/detect/road_detector.hpp"

namespace roadfix {

/// Side of the squares, of at least 16 pixels too, in which something differs where ground was seen.
inline constexpr double kBlankSideM = 16.0;

/// Marks as not observed all squares of that side, at least half of which counted as observed, in which no channel
/// varies by more than one level, and a quarter of a side around them, which codecs blur. Their corners lie on
/// multiples of a quarter of a side.
void exclude_blank(GroundImage& image);

}  // namespace roadfix
