// A town, its service, and a client that flies a track over it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/e2e/service_fixture.hpp"
#include "tests/support/flight.hpp"

namespace roadfix {

struct Request {
  std::string query;
  std::string picture;
};

/// A step as its query and its picture; without a picture it has to be sent as JSON.
inline Request request_of(const StepInput& step) {
  Request request;
  request.query =
      "?sequence=" + std::to_string(step.sequence) + "&time_us=" + std::to_string(step.time_us) + "&cell_m=2";
  if (step.odometry) {
    request.query += "&forward_m=" + std::to_string(step.odometry->forward_m) +
                     "&right_m=" + std::to_string(step.odometry->right_m) +
                     "&turn_deg=" + std::to_string(step.odometry->turn.degrees());
  }
  if (step.features) request.picture = testing::text_of(encode_feature_map(step.features->cells));
  return request;
}

class Tracks : public ::testing::Test {
 protected:
  Tracks() { testing::write_map_file(folder_ / "town.gpkg", town_.roads, 2.0); }

  /// With time for everything: a loaded machine may take minutes.
  std::unique_ptr<testing::ServiceProcess> service(std::vector<std::string> options = {}) const {
    options.insert(options.end(), {"--request-time", "600"});
    return std::make_unique<testing::ServiceProcess>(folder_.path(), options);
  }
  nlohmann::json asked() const {
    return {{"map", "town"},   {"lat", town_.place.lat_deg}, {"lon", town_.place.lon_deg},
            {"radius_m", 200}, {"particles", 2000},          {"seed", 7}};
  }
  static httplib::Client client_of(const testing::ServiceProcess& service) {
    httplib::Client client = testing::client_of(service);
    client.set_read_timeout(600);
    return client;
  }
  std::string begin(httplib::Client& client) const {
    const auto answer = client.Post("/v1/tracks", asked().dump(), "application/json");
    EXPECT_EQ(answer->status, 201) << answer->body;
    return testing::json_of(answer)["id"];
  }
  static httplib::Result send(httplib::Client& client, const std::string& id, const Request& request) {
    return client.Post(("/v1/tracks/" + id + "/steps" + request.query).c_str(), request.picture, "image/png");
  }
  std::vector<Request> flight(int steps) const {
    testing::Flight flight(town_.roads, town_.pose, 21);
    std::vector<Request> requests;
    for (int i = 0; i < steps; ++i) requests.push_back(request_of(flight.step()));
    return requests;
  }

  const testing::Town town_;
  const testing::TemporaryFolder folder_;
};

}  // namespace roadfix
