#include "server/api/track_json.hpp"

#include <span>
#include <string>

#include "core/units/error.hpp"
#include "server/api/geojson.hpp"
#include "server/api/json_parts.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

json cluster_json(const TrackCluster& cluster) {
  return {{"pose", pose_json(cluster.pose)},
          {"weight", cluster.weight},
          {"sigma_m", cluster.ellipse.sigma_m},
          {"ellipse_heading_deg", cluster.ellipse.heading.degrees()},
          {"heading_sigma_deg", cluster.heading_sigma.degrees()},
          {"radius95_m", cluster.radius95_m},
          {"scale", cluster.scale},
          {"scale_sigma", cluster.scale_sigma}};
}

}  // namespace

json to_json(const TrackEstimate& estimate) {
  json answer{{"sequence", estimate.sequence},
              {"time_us", estimate.time_us},
              {"status", estimate.converged() ? "converged" : "searching"}};
  if (estimate.unclaimed) {
    answer["reason"] = word_of(kUnclaimed, *estimate.unclaimed);
    answer["explanation"] = explanation_of(*estimate.unclaimed);
  } else {
    answer.update(cluster_json(estimate.clusters.front()));
    answer["geometry"] = point_json(estimate.clusters.front().pose.position);
  }
  answer["clusters"] = json::array();
  for (const TrackCluster& cluster : estimate.clusters) answer["clusters"].push_back(cluster_json(cluster));
  answer["cluster_count"] = estimate.cluster_count;
  answer["particles"] = estimate.particles;
  answer["resets"] = estimate.resets;
  answer["measurement"] = word_of(kMeasurements, estimate.measurement);
  answer["mean_likelihood"] = estimate.mean_likelihood;
  answer["doubt"] = estimate.doubt;
  answer["since_accepted_s"] = estimate.since_accepted_s ? json(*estimate.since_accepted_s) : json();
  answer["drifts"] = estimate.odometry_is_wrong;
  answer["missed_steps"] = estimate.missed_steps;
  if (estimate.agl_m) answer["agl_m"] = *estimate.agl_m;
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

}  // namespace roadfix::api
