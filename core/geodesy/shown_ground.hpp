// Words for whoever asks for ground beside a map.
#pragma once

#include <string>

#include "core/geodesy/geo_box.hpp"

namespace roadfix {

/// Of the box of a map's ground, not empty: "which shows latitude 37.7566 to 37.7714 and longitude 38.2667 to 38.2853".
std::string shown_ground(const UtmZone& zone, const GridBox& ground);

/// The same, and that latitude and longitude may be swapped where `asked`, a box or a point, would then lie on that
/// ground or within so many metres of it, of which no more than 10 km count.
std::string shown_ground_beside(const GeoBox& asked, double within_m, const UtmZone& zone, const GridBox& ground);

}  // namespace roadfix
