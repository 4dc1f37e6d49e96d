// Where a flight is to lead: the plan of a ground station, or a line that somebody drew.
//
// Read are plans of QGroundControl (.plan), lists of waypoints of Mission Planner, MAVProxy and others (plain text
// "QGC WPL", mavlink.io/en/file_formats), and GeoJSON (RFC 7946).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/geodesy/latlon.hpp"

namespace roadfix::routes {

struct Route {
  std::vector<LatLon> places;         ///< in the order in which they are flown to; two at least
  std::vector<std::string> left_out;  ///< parts of a plan whose way is not known, named for the user
};

/// Throws InvalidInput "waypoints-unreadable".
Route parse_route(std::string_view text);

/// The same of a file, which complaints name. Throws NotFound, too.
Route read_route(const std::filesystem::path& file);

}  // namespace roadfix::routes
