// Parts that several answers have. Degrees and metres.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/geodesy/geo_box.hpp"
#include "core/geodesy/geo_pose.hpp"
#include "core/locate/map_id.hpp"

namespace roadfix::api {

/// lat, lon and heading_deg.
nlohmann::json pose_json(const GeoPose& pose);

/// West, south, east and north, as GeoJSON has a bbox.
nlohmann::json bbox_json(const GeoBox& box);

/// Which map an answer is about.
nlohmann::json to_json(const MapId& map);
/// What made an answer: the version of the program, and the detector of frames, if any.
nlohmann::json made_by(const std::optional<std::string>& detector = {});

}  // namespace roadfix::api
