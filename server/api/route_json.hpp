// What a survey along a route found (core/survey/route_survey.hpp), as JSON.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>

#include "core/survey/route_survey.hpp"
#include "core/units/words.hpp"

namespace roadfix::api {

inline constexpr std::array<Word<PlaceKind>, 4> kPlaceKinds{{{"distinct", PlaceKind::kDistinct},
                                                             {"sparse", PlaceKind::kSparse},
                                                             {"bare", PlaceKind::kBare},
                                                             {"unknown", PlaceKind::kUnknown}}};

/// Of those pieces that were asked; there is one at least.
double share_of(const RouteSurvey& survey, PlaceKind kind);

/// How long the route is, how much of it is of each kind, and the longest way without a fix.
nlohmann::json summary_json(const RouteSurvey& survey);

/// The pieces, as a FeatureCollection of GeoJSON.
nlohmann::json geojson_of(const RouteSurvey& survey);

}  // namespace roadfix::api
