// Where a flight is to lead, and how high: the plan of a ground station, or a line that somebody drew.
//
// Read are plans of QGroundControl (.plan), lists of waypoints of Mission Planner, MAVProxy and others (plain text
// "QGC WPL", mavlink.io/en/file_formats), and GeoJSON (RFC 7946).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geodesy/latlon.hpp"

namespace roadfix::routes {

enum class HeightAbove { kSea, kHome, kGround };

struct PlannedHeight {
  double metres = 0.0;
  HeightAbove above = HeightAbove::kGround;  ///< kGround: below the place itself
  friend bool operator==(const PlannedHeight&, const PlannedHeight&) = default;
};

struct RoutePlace {
  LatLon position;
  std::optional<PlannedHeight> height;  ///< nullopt = it is not told
  std::string name;                     ///< of what tells it, for the user: "item 3", "line 4"
};

/// From whose ground heights above the home count.
struct RouteHome {
  LatLon position;
  std::optional<double> above_sea_m;  ///< as the plan tells it; nullopt = it does not
};

struct Route {
  std::vector<RoutePlace> places;     ///< in the order in which they are flown to; two at least
  std::vector<std::string> left_out;  ///< parts of a plan whose way is not known, lines beyond the first; for the user
  RouteHome home;                     ///< the first place, of a route that tells none
};

/// Throws InvalidInput "waypoints-unreadable".
Route parse_route(std::string_view text);

/// The same of a file, which complaints name. Throws NotFound, too.
Route read_route(const std::filesystem::path& file);

}  // namespace roadfix::routes
