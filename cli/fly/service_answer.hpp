// What a service answers to a step, read back.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/locate/tracker.hpp"

namespace roadfix::fly {

/// Throws InvalidInput "service-answer-unreadable".
TrackEstimate estimate_of(const nlohmann::json& answer);
/// [[lon, lat, heading_deg], ...]. Throws as estimate_of.
std::vector<GeoPose> particles_of(const nlohmann::json& list);

}  // namespace roadfix::fly
