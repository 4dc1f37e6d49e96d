// Flights as files for people's tools: a table, and GeoJSON for maps.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/fly/summary.hpp"
#include "core/geodesy/utm.hpp"

namespace roadfix::fly {

/// The column names, with a line's end.
std::string csv_header();
/// A line for each step. Covariance is that of the position of the heaviest cluster, in m^2 to true east and north, as
/// headings are from true north.
std::string csv_lines(const std::string& filter, const Run& run, const UtmZone& zone);

/// Features: the true path, the path of the steps in which the filter claimed a place, and each of these steps with its
/// 95 % ellipse.
nlohmann::json geojson_features(const std::string& filter, const Run& run, const UtmZone& zone);

}  // namespace roadfix::fly
