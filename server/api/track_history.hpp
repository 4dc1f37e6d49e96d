// The answers to the steps of a track, as files that other programs show: GeoJSON, GPX 1.1 and KML 2.2. Places are
// WGS 84, times UTC. GPX and KML hold only what was claimed.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/locate/map_id.hpp"

namespace roadfix::api {

struct FlownTrack {
  std::string id;
  MapId map;
};

/// A FeatureCollection: a point for each step, with when, how well and by what it was told; those that had not
/// converged have no geometry. Then, where two in a row had, the flight as a line that is interrupted where one had
/// not. Throws CorruptData ("track-store-corrupt"), as those below do.
nlohmann::json history_json(const FlownTrack& track, std::span<const std::string> answers);

/// One track, with a segment for each run of steps that had converged. Points have a time where `time_us` is a date.
std::string history_gpx(const FlownTrack& track, std::span<const std::string> answers);

/// The flight as lines, which are cut at 180 degrees, and a point for each step that had converged, with a time where
/// `time_us` is a date.
std::string history_kml(const FlownTrack& track, std::span<const std::string> answers);

}  // namespace roadfix::api
