// What a survey along a route found, for people.
#pragma once

#include <string>

#include "core/locate/route_survey.hpp"

namespace roadfix::cli {

/// Lines of text; `route` is what they call it. The survey is complete.
std::string route_text(const RouteSurvey& survey, const std::string& route, double footprint_m);

}  // namespace roadfix::cli
