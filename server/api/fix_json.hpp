// Fixes and match scores as the API and `roadfix --json` give them.
//
// Degrees, metres, milliseconds. A position stands at the top only in an answer of status "fix"; otherwise only the
// modes have one. `geometry` beside it is the same position as GeoJSON.
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "core/locate/fix.hpp"
#include "core/match/correlation.hpp"
#include "core/survey/localizability.hpp"
#include "server/api/features.hpp"

namespace roadfix::api {

/// "fix", "ambiguous" or "no_fix".
const char* to_string(FixStatus status);

nlohmann::json to_json(const Fix& fix);
/// With what the features that it was found by tell of frames: their detector and how long that took, the camera, and
/// which were left out.
nlohmann::json to_json(const Fix& fix, const Features& features);

nlohmann::json to_json(const Localizability& place);

/// One of "scores" per pose: rho and probability (equations 5 and 7) are null where they are not defined.
nlohmann::json to_json(std::span<const MatchScore> scores, const MapView& map, const Features& features);

}  // namespace roadfix::api
