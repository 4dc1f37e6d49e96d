#include "server/api/track_json.hpp"

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/units/error.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/geojson.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

json cluster_json(const TrackCluster& cluster) {
  json answer = placed_json(cluster.pose);
  answer.update({{"weight", cluster.weight},
                 {"sigma_m", cluster.sigma_m},
                 {"ellipse_heading_deg", cluster.ellipse_heading.degrees()},
                 {"heading_sigma_deg", cluster.heading_sigma.degrees()},
                 {"radius95_m", cluster.radius95_m},
                 {"scale", cluster.scale},
                 {"scale_sigma", cluster.scale_sigma}});
  return answer;
}

/// What a point of a history has of the answer to its step.
json told_of(const json& answer) {
  json properties = json::object();
  for (const char* name : {"sequence", "time_us", "status", "sigma_m", "ellipse_heading_deg", "heading_sigma_deg",
                           "radius95_m", "measurement", "doubt", "drifts", "resets", "made_by"}) {
    if (answer.contains(name)) properties[name] = answer.at(name);
  }
  return properties;
}

}  // namespace

json to_json(const TrackEstimate& estimate) {
  json answer{{"sequence", estimate.sequence},
              {"time_us", estimate.time_us},
              {"status", estimate.converged ? "converged" : "searching"}};
  if (estimate.converged) answer.update(cluster_json(estimate.clusters.front()));
  answer["clusters"] = json::array();
  for (const TrackCluster& cluster : estimate.clusters) answer["clusters"].push_back(cluster_json(cluster));
  answer["cluster_count"] = estimate.cluster_count;
  answer["particles"] = estimate.particles;
  answer["resets"] = estimate.resets;
  answer["measurement"] = to_string(estimate.measurement);
  answer["mean_likelihood"] = estimate.mean_likelihood;
  answer["doubt"] = estimate.doubt;
  answer["since_accepted_s"] = estimate.since_accepted_s ? json(*estimate.since_accepted_s) : json();
  answer["drifts"] = estimate.drifts;
  answer["missed_steps"] = estimate.missed_steps;
  return answer;
}

json particles_json(std::span<const GeoPose> particles) {
  json list = json::array();
  for (const GeoPose& p : particles) {
    list.push_back({p.position.lon_deg, p.position.lat_deg, p.heading.compass_degrees()});
  }
  return list;
}

json stored_json(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  if (value.is_discarded()) {
    throw CorruptData("track-store-corrupt", "what is stored of a track is damaged: delete it and begin a new one");
  }
  return value;
}

json history_json(std::span<const std::string> answers) {
  json features = json::array();
  std::vector<std::vector<LatLon>> stretches(1);  // where a place was claimed at every step
  for (const std::string& text : answers) {
    const json answer = stored_json(text);
    json properties = told_of(answer);
    const bool placed = answer.contains("geometry");
    if (placed) {
      properties["heading_deg"] = answer.at("pose").at("heading_deg");
      const json& place = answer.at("geometry").at("coordinates");
      stretches.back().push_back({place.at(1).get<double>(), place.at(0).get<double>()});
    } else if (!stretches.back().empty()) {
      stretches.emplace_back();
    }
    features.push_back({{"type", "Feature"},
                        {"geometry", placed ? answer.at("geometry") : json()},
                        {"properties", std::move(properties)}});
  }
  std::erase_if(stretches, [](const auto& stretch) { return stretch.size() < 2; });
  if (!stretches.empty()) {
    features.push_back({{"type", "Feature"}, {"geometry", line_json(stretches)}, {"properties", json::object()}});
  }
  return {{"type", "FeatureCollection"}, {"features", std::move(features)}};
}

}  // namespace roadfix::api
