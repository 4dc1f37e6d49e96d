#include "server/api/track_json.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/locate/recent_frames_bytes.hpp"
#include "core/units/error.hpp"
#include "server/api/base64.hpp"
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

json json_of(std::optional<std::int64_t> time_us) { return time_us ? json(*time_us) : json(); }

json json_of(const std::optional<BodyVelocity>& velocity) {
  return velocity ? json::array({velocity->forward_m_s, velocity->right_m_s}) : json();
}

std::optional<BodyVelocity> velocity_of(const json& velocity) {
  if (velocity.is_null()) return std::nullopt;
  return BodyVelocity{velocity.at(0), velocity.at(1)};
}

json json_of(const LastView& view) {
  const std::vector<std::byte> earlier = to_bytes(view.earlier);
  return {{"digest", view.digest},
          {"moved_m", view.moved_m},
          {"turned_rad", view.turned_rad},
          {"stands_still", view.stands_still},
          {"earlier", base64_encoded({reinterpret_cast<const std::uint8_t*>(earlier.data()), earlier.size()})}};
}

RecentFrames frames_of(const std::string& base64) {
  const Base64Result decoded = base64_decoded(base64);
  if (decoded.bad_byte) {
    throw CorruptData("track-frames-corrupt",
                      "the stored frames of a track are no base64: delete the track and begin a new one");
  }
  return recent_frames_of(std::as_bytes(std::span(decoded.bytes)));
}

LastView view_of(const json& view) {
  return {view.at("digest").get_ref<const json::number_unsigned_t&>(), view.at("moved_m"), view.at("turned_rad"),
          view.at("stands_still"), frames_of(view.at("earlier"))};
}

/// Throws where it is no whole number; get() would take any, and one beyond the range for anything.
std::int64_t whole(const json& number) { return number.get_ref<const json::number_integer_t&>(); }

std::optional<std::int64_t> time_of(const json& time_us) {
  return time_us.is_null() ? std::nullopt : std::optional(whole(time_us));
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
  std::vector<LatLon> line;
  for (const std::string& text : answers) {
    const json answer = stored_json(text);
    json properties{
        {"sequence", answer.at("sequence")}, {"time_us", answer.at("time_us")}, {"status", answer.at("status")}};
    const bool placed = answer.contains("geometry");
    if (placed) {
      for (const char* name : {"sigma_m", "ellipse_heading_deg", "heading_sigma_deg"})
        properties[name] = answer.at(name);
      properties["heading_deg"] = answer.at("pose").at("heading_deg");
      const json& place = answer.at("geometry").at("coordinates");
      line.push_back({place.at(1).get<double>(), place.at(0).get<double>()});
    }
    features.push_back({{"type", "Feature"},
                        {"geometry", placed ? answer.at("geometry") : json()},
                        {"properties", std::move(properties)}});
  }
  if (line.size() > 1) {
    features.push_back({{"type", "Feature"}, {"geometry", line_json(line)}, {"properties", json::object()}});
  }
  return {{"type", "FeatureCollection"}, {"features", std::move(features)}};
}

json counters_json(const TrackerState& state) {
  return {{"sequence", state.sequence},
          {"time_us", state.time_us},
          {"searched", state.searched},
          {"compared", state.claim.confirmed},
          {"measured", state.measured},
          {"last_search", state.last_search},
          {"supported", state.claim.supported},
          {"evidence", state.claim.log_odds},
          {"accepted_time_us", json_of(state.accepted_time_us)},
          {"looked_time_us", json_of(state.claim.looked_time_us)},
          {"drifts", state.motion.drifts},
          {"velocity", json_of(state.motion.velocity)},
          {"last_view", json_of(state.last_view)},
          {"coasts", state.motion.coasts},
          {"nadir_sigma_m", state.nadir_sigma_m}};
}

TrackerState state_of(const json& counters, FilterState filter) {
  TrackerState state;
  state.filter = std::move(filter);
  state.started = true;
  try {
    state.sequence = whole(counters.at("sequence"));
    state.time_us = whole(counters.at("time_us"));
    state.searched = counters.at("searched");
    state.claim.confirmed = counters.at("compared");
    state.measured = whole(counters.at("measured"));
    state.last_search = whole(counters.at("last_search"));
    state.claim.supported = whole(counters.at("supported"));
    state.claim.log_odds = counters.at("evidence");
    state.accepted_time_us = time_of(counters.at("accepted_time_us"));
    state.claim.looked_time_us = time_of(counters.at("looked_time_us"));
    state.motion.drifts = counters.at("drifts");
    state.nadir_sigma_m = counters.at("nadir_sigma_m");
    state.motion.velocity = velocity_of(counters.at("velocity"));
    state.last_view = view_of(counters.at("last_view"));
    state.motion.coasts = counters.at("coasts");
  } catch (const json::exception& error) {
    throw CorruptData("track-store-corrupt", std::string("the stored counters of a track cannot be read (") +
                                                 error.what() + "): delete the track and begin a new one");
  }
  return state;
}

}  // namespace roadfix::api
