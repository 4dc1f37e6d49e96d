// What a service answers about its maps, to a track that begins and to its steps, read back. All throw InvalidInput
// "service-answer-unreadable".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/track/tracker.hpp"

namespace roadfix::fly {

/// Of the map of this name in the list of maps; nullopt where there is none, or one that cannot be read.
std::optional<std::string> version_in(const nlohmann::json& answer, const std::string& map);
/// Of the track that was begun.
std::string track_id_of(const nlohmann::json& answer);
TrackEstimate estimate_of(const nlohmann::json& answer);
/// [[lon, lat, heading_deg], ...].
std::vector<GeoPose> particles_of(const nlohmann::json& list);

}  // namespace roadfix::fly
