// What a survey along a route found, as text, JSON and GeoJSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/locate/route_survey.hpp"

namespace roadfix::cli {

/// Lines for people; `route` is what they call it.
std::string route_text(const RouteSurvey& survey, const std::string& route, double footprint_m);

nlohmann::json route_json(const RouteSurvey& survey);

/// A FeatureCollection of its pieces.
nlohmann::json route_geojson(const RouteSurvey& survey);

}  // namespace roadfix::cli
