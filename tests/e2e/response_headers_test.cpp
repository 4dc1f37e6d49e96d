// Each header that the service sends is described in /openapi.json where it is sent, and each that is described is
// sent.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <set>
#include <thread>

#include "tests/e2e/described_service.hpp"
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

class ResponseHeaders : public testing::DescribedService {
 protected:
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

  const std::string path = "/v1/maps/town/tiles/" + tile();
  const auto shown = client_->Get(path);
  expect_described("getTile", 200, shown);
  expect_described("getTile", 304, client_->Get(path, {{"If-None-Match", shown->get_header_value("ETag")}}));
  expect_described("getTile", 204, client_->Get("/v1/maps/town/tiles/16/0/0.png"));

  expect_described("getWindow", 200, client_->Get("/v1/maps/town/window?width_m=100&height_m=100&" + place()));
  expect_described("detectRoads", 200, client_->Post("/v1/detect?gsd_m=2", town_.seen(), "image/png"));
  const std::string fix = "/v1/maps/town/fix?cell_m=2&radius_m=300&" + place();
  expect_described("findFix", 200, client_->Post(fix + "&format=gps_input", town_.seen(), "image/png"));
  expect_described("findFix", 204, client_->Post(fix + "&format=command_int", nothing(), "image/png"));

  const json track{{"map", "town"}, {"particles", 200}};
  const auto begun = client_->Post("/v1/tracks", track.dump(), "application/json");
  expect_described("beginTrack", 201, begun);
  expect_described("beginTrack", 429, client_->Post("/v1/tracks", track.dump(), "application/json"));
  const std::string id = testing::json_of(begun)["id"];
  const std::string steps = "/v1/tracks/" + id + "/steps";
  const std::string step = json{{"sequence", 0}, {"time_us", 1}}.dump();
  expect_described("takeStep", 200, client_->Post(steps, step, "application/json"));
  expect_described("takeStep", 200, client_->Post(steps + "?format=nmea", step, "application/json"));
  expect_described("takeStep", 204, client_->Post(steps + "?format=command_int", step, "application/json"));
  expect_described("getTrackHistory", 200, client_->Get("/v1/tracks/" + id + "/history?format=gpx"));
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
