#include "server/api/track_history.hpp"

#include <utility>
#include <vector>

#include "server/api/geojson.hpp"
#include "server/api/json_parts.hpp"
#include "server/api/track_claims.hpp"
#include "server/api/track_json.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

json properties_of(const json& answer) {
  json properties = json::object();
  for (const char* name : {"sequence", "time_us", "status", "reason", "sigma_m", "ellipse_heading_deg",
                           "heading_sigma_deg", "radius95_m", "measurement", "doubt", "drifts", "resets", "made_by"}) {
    if (answer.contains(name)) properties[name] = answer.at(name);
  }
  const std::string date = date_of(answer.at("time_us"));
  if (!date.empty()) properties["time"] = date;
  if (answer.contains("pose")) properties["heading_deg"] = answer.at("pose").at("heading_deg");
  return properties;
}

/// Of those stretches that have two places at least.
std::vector<std::vector<LatLon>> lines_of(const std::vector<ClaimedStretch>& stretches) {
  std::vector<std::vector<LatLon>> lines;
  for (const ClaimedStretch& stretch : stretches) {
    if (stretch.size() < 2) continue;
    std::vector<LatLon>& line = lines.emplace_back();
    for (const Claim& claim : stretch) line.push_back(claim.at);
  }
  return lines;
}

}  // namespace

json history_json(const FlownTrack& track, std::span<const std::string> answers) {
  json features = json::array();
  std::vector<ClaimedStretch> stretches(1);
  for (const std::string& text : answers) {
    const json answer = stored_json(text);
    continue_with(stretches, answer);
    features.push_back({{"type", "Feature"},
                        {"geometry", answer.contains("geometry") ? answer.at("geometry") : json()},
                        {"properties", properties_of(answer)}});
  }
  const auto lines = lines_of(stretches);
  if (!lines.empty()) {
    features.push_back({{"type", "Feature"}, {"geometry", line_json(lines)}, {"properties", json::object()}});
  }
  return {{"type", "FeatureCollection"},
          {"track", track.id},
          {"map", to_json(track.map)},
          {"features", std::move(features)}};
}

}  // namespace roadfix::api
