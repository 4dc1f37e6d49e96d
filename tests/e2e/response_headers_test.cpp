// Each header that the service sends is described in /openapi.json where it is sent, and each that is described is
// sent.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include "server/api/web_mercator.hpp"
#include "tests/e2e/service_fixture.hpp"
#include "tests/support/eventually.hpp"

namespace roadfix {
namespace {

using nlohmann::json;

/// Of HTTP itself and of every answer (the document says so of X-Request-Id at its beginning).
const std::set<std::string> kOfAllAnswers{"connection",  "content-encoding", "content-length", "content-type",
                                          "date",        "keep-alive",       "vary",           "transfer-encoding",
                                          "x-request-id"};

std::string lower(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

class ResponseHeaders : public ::testing::Test {
 protected:
  ResponseHeaders() {
    testing::write_map_file(folder_ / "town.gpkg", town_.roads, 2.0);
    service_.emplace(folder_.path(), std::vector<std::string>{"--max-client-tracks", "1", "--request-time", "600"});
    client_.emplace(testing::client_of(*service_));
    document_ = testing::json_of(client_->Get("/openapi.json"));
  }

  const json& resolved(const json& node) const {
    if (!node.contains("$ref")) return node;
    return document_.at(json::json_pointer(node["$ref"].get<std::string>().substr(1)));
  }

  void expect_described(const char* operation_id, int status, const httplib::Result& answer) {
    ASSERT_TRUE(answer) << operation_id;
    ASSERT_EQ(answer->status, status) << operation_id << " " << answer->body;
    std::set<std::string> described;
    const json headers = response(operation_id, status).value("headers", json::object());
    for (const auto& [name, header] : headers.items()) {
      EXPECT_TRUE(resolved(header).contains("schema")) << name;
      described.insert(lower(name));
    }
    for (const auto& [name, value] : answer->headers) {
      if (kOfAllAnswers.contains(lower(name))) continue;
      EXPECT_TRUE(described.contains(lower(name))) << operation_id << " " << status << " sends " << name;
      sent_.insert(lower(name));
    }
  }

  const json& response(const std::string& operation_id, int status) const {
    for (const auto& [path, item] : document_.at("paths").items()) {
      for (const auto& [method, operation] : item.items()) {
        if (method == "parameters" || operation.at("operationId") != operation_id) continue;
        const json& responses = operation.at("responses");
        const std::string key = std::to_string(status);
        return resolved(responses.contains(key) ? responses[key] : responses.at("default"));
      }
    }
    throw std::runtime_error("no operation " + operation_id);
  }

  const testing::Town town_;
  const testing::TemporaryFolder folder_;
  std::optional<testing::ServiceProcess> service_;
  std::optional<httplib::Client> client_;
  json document_;
  std::set<std::string> sent_;
};

TEST_F(ResponseHeaders, AreDescribedWhereTheyAreSent) {
  const auto page = client_->Get("/");
  const httplib::Headers known{{"If-None-Match", page->get_header_value("ETag")}};
  expect_described("getConsole", 200, page);
  expect_described("getConsole", 304, client_->Get("/", known));
  expect_described("getConsoleFile", 200, client_->Get("/console/main.js"));
  expect_described("getMap", 200, client_->Get("/v1/maps/town"));
  expect_described("getMap", 405, client_->Delete("/v1/maps/town"));
  expect_described("getTileJson", 200, client_->Get("/v1/maps/town/tilejson.json"));
  expect_described("getLocalizabilityTileJson", 200, client_->Get("/v1/maps/town/localizability/tilejson.json"));
  expect_described("getLocalizabilityTile", 204, client_->Get("/v1/maps/town/localizability/tiles/16/0/0.png"));

  const api::MercatorPixel pixel = api::mercator_pixel(town_.place, 16);
  const std::string path = "/v1/maps/town/tiles/16/" + std::to_string(static_cast<int>(pixel.x / 256)) + "/" +
                           std::to_string(static_cast<int>(pixel.y / 256)) + ".png";
  const auto tile = client_->Get(path);
  expect_described("getTile", 200, tile);
  expect_described("getTile", 304, client_->Get(path, {{"If-None-Match", tile->get_header_value("ETag")}}));
  expect_described("getTile", 204, client_->Get("/v1/maps/town/tiles/16/0/0.png"));

  const std::string place =
      "lat=" + std::to_string(town_.place.lat_deg) + "&lon=" + std::to_string(town_.place.lon_deg);
  expect_described("getWindow", 200, client_->Get("/v1/maps/town/window?width_m=100&height_m=100&" + place));
  expect_described("detectRoads", 200, client_->Post("/v1/detect?gsd_m=2", town_.seen(), "image/png"));
  const std::string fix = "/v1/maps/town/fix?cell_m=2&radius_m=300&" + place;
  expect_described("findFix", 200, client_->Post(fix + "&format=gps_input", town_.seen(), "image/png"));
  const std::string empty = testing::text_of(encode_feature_map(CellArray(128, 128, kNoRoad)));
  expect_described("findFix", 204, client_->Post(fix + "&format=command_int", empty, "image/png"));

  const json track{{"map", "town"}, {"start", "uniform"}, {"particles", 200}};
  const auto begun = client_->Post("/v1/tracks", track.dump(), "application/json");
  expect_described("beginTrack", 201, begun);
  expect_described("beginTrack", 429, client_->Post("/v1/tracks", track.dump(), "application/json"));
  const std::string id = testing::json_of(begun)["id"];
  const std::string steps = "/v1/tracks/" + id + "/steps";
  const std::string step = json{{"sequence", 0}, {"time_us", 1}}.dump();
  expect_described("takeStep", 200, client_->Post(steps, step, "application/json"));
  expect_described("takeStep", 200, client_->Post(steps + "?format=nmea", step, "application/json"));
  expect_described("takeStep", 204, client_->Post(steps + "?format=command_int", step, "application/json"));
  std::atomic<bool> listening = false;
  const std::jthread end([&] {
    EXPECT_TRUE(testing::eventually([&] { return listening.load(); }));
    testing::client_of(*service_).Delete("/v1/tracks/" + id);
  });
  expect_described("getTrackEvents", 200, client_->Get("/v1/tracks/" + id + "/events", [&](const char*, std::size_t) {
    listening = true;
    return true;
  }));

  for (const auto& [name, header] : document_.at("components").at("headers").items()) {
    EXPECT_TRUE(sent_.contains(lower(name))) << name << " is described and was not sent";
  }
}

}  // namespace
}  // namespace roadfix
