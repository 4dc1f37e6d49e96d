#include "cli/fly/service_answer.hpp"

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/units/error.hpp"

namespace roadfix::fly {
namespace {

using nlohmann::json;

InvalidInput unreadable(const std::string& what) {
  return {"service-answer-unreadable",
          "the service answered what none does that tracks vehicles (" + what + "): is it a Roadfix of this version?"};
}

TrackCluster cluster_of(const json& value) {
  const json& pose = value.at("pose");
  return {{{pose.at("lat"), pose.at("lon")}, Angle::degrees(pose.at("heading_deg"))},
          value.at("weight"),
          {value.at("sigma_m").get<std::array<double, 2>>(), Angle::degrees(value.at("ellipse_heading_deg"))},
          Angle::degrees(value.at("heading_sigma_deg")),
          value.at("radius95_m"),
          value.at("scale"),
          value.at("scale_sigma")};
}

template <typename E, std::size_t N>
E value_by(const std::array<Word<E>, N>& words, const json& answer, const char* member) {
  const std::string& word = answer.at(member).get_ref<const std::string&>();
  const std::optional<E> value = value_of(words, word);
  if (!value) throw unreadable(std::string(member) + " " + word);
  return *value;
}

std::optional<Unclaimed> unclaimed_by(const json& answer) {
  if (answer.at("status") == "converged") return std::nullopt;
  return value_by(kUnclaimed, answer, "reason");
}

}  // namespace

TrackEstimate estimate_of(const json& answer) {
  TrackEstimate estimate;
  try {
    estimate.sequence = answer.at("sequence");
    estimate.time_us = answer.at("time_us");
    estimate.unclaimed = unclaimed_by(answer);
    for (const json& cluster : answer.at("clusters")) estimate.clusters.push_back(cluster_of(cluster));
    estimate.cluster_count = answer.at("cluster_count");
    estimate.particles = answer.at("particles");
    estimate.resets = answer.at("resets");
    estimate.measurement = value_by(kMeasurements, answer, "measurement");
    estimate.mean_likelihood = answer.at("mean_likelihood");
    estimate.doubt = answer.at("doubt");
    const json& accepted = answer.at("since_accepted_s");
    if (!accepted.is_null()) estimate.since_accepted_s = accepted.get<double>();
    estimate.odometry_is_wrong = answer.at("drifts");
    estimate.missed_steps = answer.at("missed_steps");
  } catch (const json::exception& error) {
    throw unreadable(error.what());
  }
  if (estimate.clusters.empty()) throw unreadable("no clusters");
  return estimate;
}

std::optional<std::string> version_in(const json& answer, const std::string& map) {
  const auto maps = answer.find("maps");
  if (maps == answer.end() || !maps->is_array()) throw unreadable("no maps");
  for (const json& one : *maps) {
    const auto name = one.find("name");
    const auto version = one.find("version");
    if (name != one.end() && *name == map && version != one.end() && version->is_string()) {
      return version->get<std::string>();
    }
  }
  return std::nullopt;
}

std::string track_id_of(const json& answer) {
  const auto id = answer.find("id");
  if (id != answer.end() && id->is_string()) return id->get<std::string>();
  throw unreadable("no id");
}

std::vector<GeoPose> particles_of(const json& list) {
  std::vector<GeoPose> poses;
  try {
    for (const json& p : list) poses.push_back({{p.at(1), p.at(0)}, Angle::degrees(p.at(2))});
  } catch (const json::exception& error) {
    throw unreadable(error.what());
  }
  return poses;
}

}  // namespace roadfix::fly
