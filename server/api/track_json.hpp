// Tracks as the API gives them. A pose stands at the top only where the track has converged.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/locate/track_estimate.hpp"

namespace roadfix::api {

nlohmann::json to_json(const TrackEstimate& estimate);

/// [lon, lat, heading_deg] of each.
nlohmann::json particles_json(std::span<const GeoPose> particles);

/// Answers to steps as a GeoJSON FeatureCollection: a point for each, with when, how well and by what it was told;
/// those that had not converged have no geometry. Then, where two in a row had, the flight as a line that is
/// interrupted where one had not. Throws CorruptData ("track-store-corrupt").
nlohmann::json history_json(std::span<const std::string> answers);

/// Text of the store. Throws CorruptData ("track-store-corrupt").
nlohmann::json stored_json(const std::string& text);

}  // namespace roadfix::api
