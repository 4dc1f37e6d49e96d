// What a survey along a route found, for people.
#pragma once

#include <optional>
#include <string>

#include "core/survey/route_survey.hpp"

namespace roadfix::cli {

/// Lines of text; `route` is what they call it. The survey is complete. `footprint_m`: nullopt = by a camera.
std::string route_text(const RouteSurvey& survey, const std::string& route, std::optional<double> footprint_m);

}  // namespace roadfix::cli
