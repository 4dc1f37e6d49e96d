// What the readers of routes share.
#pragma once

#include <optional>
#include <vector>

#include "core/units/json_file.hpp"

namespace roadfix::routes {

inline constexpr const char* kRouteUnreadable = "waypoints-unreadable";

inline constexpr double kHighestM = 100'000.0;  // and lowest: nothing that looks for roads flies there

inline const JsonFile kRouteJson{
    "route", kRouteUnreadable, kRouteUnreadable,
    "a route is a plan of QGroundControl, a list of waypoints (QGC WPL), or GeoJSON with a line or points"};

inline double latitude_of(const JsonField& number) { return number.number(-90.0, 90.0); }
inline double longitude_of(const JsonField& number) { return number.number(-180.0, 180.0); }

/// The third of the numbers of a position; nullopt where it is none.
inline std::optional<double> third_number(const std::vector<JsonField>& position) {
  if (position.size() < 3 || !position[2].is_number()) return std::nullopt;
  return position[2].number(-kHighestM, kHighestM);
}

}  // namespace roadfix::routes
