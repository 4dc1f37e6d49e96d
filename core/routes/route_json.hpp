// What the readers of routes share.
#pragma once

#include "core/units/json_file.hpp"

namespace roadfix::routes {

inline constexpr const char* kRouteUnreadable = "waypoints-unreadable";

inline const JsonFile kRouteJson{
    "route", kRouteUnreadable, kRouteUnreadable,
    "a route is a plan of QGroundControl, a list of waypoints (QGC WPL), or GeoJSON with a line or points"};

inline double latitude_of(const JsonField& number) { return number.number(-90.0, 90.0); }
inline double longitude_of(const JsonField& number) { return number.number(-180.0, 180.0); }

}  // namespace roadfix::routes
