// Tracks and their steps as a client gives them.
#pragma once

#include <string>
#include <vector>

#include "core/track/tracker.hpp"
#include "server/api/fields.hpp"
#include "server/api/limits.hpp"

namespace roadfix::api {

/// Members of the JSON that begins a track: "map" and what is known of place and vehicle.
const std::vector<std::string>& track_members();

struct TrackRequest {
  std::string map;
  TrackSettings settings;
};
TrackRequest parse_track(const Fields& fields, const Limits& limits);

/// Names of a step beside those of its feature map or frame.
const std::vector<std::string>& step_fields();
/// Without the feature map. forward_m, right_m and turn_deg go together; "covariance" is that of forward, right (m) and
/// turn (rad), row by row.
StepInput parse_step(const Fields& fields);

}  // namespace roadfix::api
