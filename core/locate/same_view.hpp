// When two frames are one picture: a camera or a link that has stopped shows it again and again.
#pragma once

#include "core/grid/feature_map.hpp"

namespace roadfix {

/// From here on a movement counts: a hovering simulator draws the same picture again and again, while its odometry may
/// jitter.
inline constexpr double kMovedM = 1.0;
/// Whether a vehicle that moved or turned so far has to see something else.
bool has_moved(double moved_m, double turned_rad);

bool has_road_cell(const FeatureMap& features);

/// Whether two pictures are the same to the last cell. False without any road: one wood looks like the next.
bool is_same_view(const FeatureMap& a, const FeatureMap& b);

}  // namespace roadfix
