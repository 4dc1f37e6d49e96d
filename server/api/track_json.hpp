// Tracks as the API gives them. A pose stands at the top only where the track has converged.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/track/track_estimate.hpp"

namespace roadfix::api {

nlohmann::json to_json(const TrackEstimate& estimate);

/// [lon, lat, heading_deg] of each.
nlohmann::json particles_json(std::span<const GeoPose> particles);

/// Text of the store. Throws CorruptData ("track-store-corrupt").
nlohmann::json stored_json(const std::string& text);

}  // namespace roadfix::api
