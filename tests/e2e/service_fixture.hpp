// A town as a map file, the service that serves it, and what a UAV above it would see.
#pragma once

#include <httplib.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "core/detect/feature_map_codec.hpp"
#include "tests/e2e/service_process.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::testing {

inline std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

struct Town {
  UtmZone zone = UtmZone::from_epsg(32634).value();
  RoadGrid roads = street_map(41, {2.0, {300'100, -3'200'050}, 500, 450});
  GridPose pose{{600'700.0, 6'399'600.0}, Angle::degrees(217.0)};
  LatLon place = zone.unproject(pose.position);
  double heading_deg = zone.true_from_grid(pose.heading, pose.position).compass_degrees();

  /// Feature map of a flight over the pose, 2 m cells, as PNG.
  std::string seen() const { return seen_from(pose, 160); }
  std::string seen_from(const GridPose& from, int side) const {
    std::mt19937_64 random(42);
    return text_of(encode_feature_map(observed_at(roads, from, side, side, 2.0, {0.1, 0.1}, random).cells));
  }
};

inline httplib::Client client_of(const ServiceProcess& service) {
  httplib::Client client("127.0.0.1", service.port());
  client.set_tcp_nodelay(true);
  client.set_keep_alive(true);
  client.set_read_timeout(600);
  return client;
}

inline nlohmann::json json_of(const httplib::Result& answer) { return nlohmann::json::parse(answer.value().body); }

/// Status and code of a refusal: "400 missing-parameter lat".
inline std::string refusal(const httplib::Result& answer) {
  if (!answer) return "no answer: " + httplib::to_string(answer.error());
  if (answer->get_header_value("Content-Type") != "application/problem+json")
    return std::to_string(answer->status) + " no problem";
  const auto body = nlohmann::json::parse(answer->body);
  std::string text = std::to_string(answer->status) + " " + body.value("code", "?");
  if (body.contains("field")) text.append(" ").append(body["field"].get<std::string>());
  return text;
}

}  // namespace roadfix::testing
