// Every kind of answer that /openapi.json describes is given, and each is as it is described.
#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <set>
#include <thread>

#include "tests/e2e/described_service.hpp"
#include "tests/e2e/tracks_fixture.hpp"
#include "tests/support/eventually.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using ::testing::IsEmpty;

class ResponseBodies : public testing::DescribedService {
 protected:
  void expect_as_described(const std::string& operation_id, int status, const httplib::Result& answer) {
    ASSERT_TRUE(answer) << operation_id;
    ASSERT_EQ(answer->status, status) << operation_id << " " << answer->body;
    const std::string sent = answer->get_header_value("Content-Type");
    const std::string type = sent.substr(0, sent.find(';'));
    const json content = response(operation_id, status).value("content", json::object());
    EXPECT_EQ(content.empty(), answer->body.empty()) << operation_id << " " << status;
    if (content.empty()) return;
    ASSERT_TRUE(content.contains(type)) << operation_id << " " << status << " sends " << type;
    if (status < 400) given_.insert(operation_id + " " + type);
    if (type.ends_with("json")) expect_as(content[type]["schema"], answer->body, operation_id);
  }
  void expect_as(const json& schema, const std::string& text, const std::string& what) const {
    const json body = json::parse(text);
    EXPECT_THAT(testing::breaches(document_, schema, body), IsEmpty()) << what << " " << body;
  }

  /// "findFix application/json" of all that is described, but for what means a mistake.
  std::set<std::string> described() const {
    std::set<std::string> all;
    for (const auto& [path, item] : document_.at("paths").items()) {
      for (const auto& [method, operation] : item.items()) {
        if (method == "parameters") continue;
        for (const auto& [status, answer] : operation.at("responses").items()) {
          if (status == "default") continue;
          const json contents = resolved(answer).value("content", json::object());
          for (const auto& [type, content] : contents.items()) {
            all.insert(operation.at("operationId").get<std::string>() + " " + type);
          }
        }
      }
    }
    return all;
  }

  void ask_what_is_served() {
    expect_as_described("getConsole", 200, client_->Get("/"));
    for (const char* file : {"main.js", "console.css", "index.html", "leaflet-licence.txt"}) {
      expect_as_described("getConsoleFile", 200, client_->Get(std::string("/console/") + file));
    }
    expect_as_described("getHealth", 200, client_->Get("/healthz"));
    expect_as_described("getReadiness", 200, client_->Get("/readyz"));
    expect_as_described("getMetrics", 200, client_->Get("/metrics"));
    expect_as_described("getOpenApi", 200, client_->Get("/openapi.json"));
    expect_as_described("getLimits", 200, client_->Get("/v1/limits"));
  }

  void ask_for_the_map() {
    const std::string map = "/v1/maps/town";
    expect_as_described("listMaps", 200, client_->Get("/v1/maps"));
    expect_as_described("getMap", 200, client_->Get(map));
    expect_as_described("getMap", 404, client_->Get("/v1/maps/none"));
    for (const char* format : {"png", "tiff", "json"}) {
      expect_as_described("getWindow", 200,
                          client_->Get(map + "/window?width_m=100&height_m=100&format=" + format + "&" + place()));
    }
    expect_as_described("getTile", 200, client_->Get(map + "/tiles/" + tile()));
    expect_as_described("getTileJson", 200, client_->Get(map + "/tilejson.json"));
    for (const char* footprint_m : {"60", "400"}) {
      expect_as_described("getLocalizability", 200,
                          client_->Get(map + "/localizability?footprint_m=" + footprint_m + "&" + place()));
    }
    const LatLon at = town_.place;
    const json line{{"type", "LineString"},
                    {"coordinates", {{at.lon_deg, at.lat_deg}, {at.lon_deg + 0.001, at.lat_deg}}}};
    expect_as_described(
        "findRouteLocalizability", 200,
        client_->Post(map + "/localizability?footprint_m=400&places=2", line.dump(), "application/json"));
    expect_as_described(
        "findRouteLocalizability", 200,
        client_->Post(map + "/localizability?fov_deg=70&agl_m=300&places=2", line.dump(), "application/json"));
    expect_as_described("findRouteLocalizability", 422,
                        client_->Post(map + "/localizability?footprint_m=400", "{}", "application/json"));
    expect_as_described("getLocalizabilityTileJson", 200, client_->Get(map + "/localizability/tilejson.json"));
    expect_as_described("getLocalizabilityTile", 200, client_->Get(map + "/localizability/tiles/" + tile()));
  }

  void ask_where_a_picture_is_from() {
    const std::string fix = "/v1/maps/town/fix?cell_m=2&radius_m=300&" + place();
    expect_as_described("findFix", 200, client_->Post(fix, town_.seen(), "image/png"));
    expect_as_described("findFix", 200, client_->Post(fix, nothing(), "image/png"));
    expect_as_described("findFix", 400, client_->Post(fix + "&heading_deg=north", town_.seen(), "image/png"));
    for (const char* format : kFormats) {
      expect_as_described("findFix", 200, client_->Post(fix + "&format=" + format, town_.seen(), "image/png"));
    }
    json request =
        testing::json_of(client_->Get("/v1/maps/town/window?width_m=200&height_m=200&format=json&" + place()));
    json far = request["pose"];
    far["lat"] = 0;
    request["poses"] = {request["pose"], far};
    expect_as_described("matchPoses", 200, client_->Post("/v1/maps/town/match", request.dump(), "application/json"));
    expect_as_described("detectRoads", 200, client_->Post("/v1/detect?gsd_m=2", town_.seen(), "image/png"));
    expect_as_described("detectRoads", 200, client_->Post("/v1/detect?gsd_m=2&format=json", town_.seen(), "image/png"));
  }

  void fly() {
    const json begun{{"map", "town"},   {"lat", town_.place.lat_deg}, {"lon", town_.place.lon_deg},
                     {"radius_m", 200}, {"particles", 2000},          {"seed", 7}};
    const auto track = client_->Post("/v1/tracks", begun.dump(), "application/json");
    expect_as_described("beginTrack", 201, track);
    expect_as_described("beginTrack", 429, client_->Post("/v1/tracks", begun.dump(), "application/json"));
    const std::string url = "/v1/tracks/" + testing::json_of(track)["id"].get<std::string>();
    const auto take = [&](const Request& step, const std::string& more = "") {
      return client_->Post(url + "/steps" + step.query + more, step.picture, "image/png");
    };
    testing::Flight flight(town_.roads, town_.pose, 20);
    Request step;
    for (int i = 0; i < 8; ++i) {
      step = request_of(flight.step());
      expect_as_described("takeStep", 200, take(step));
    }
    expect_as_described("takeStep", 200, take(step));
    expect_as_described("takeStep", 409, take({step.query, nothing()}));
    for (const char* format : kFormats) {
      expect_as_described("takeStep", 200, take(request_of(flight.step()), std::string("&format=") + format));
    }
    expect_as_described("getTrack", 200, client_->Get(url + "?particles=5"));
    expect_as_described("listTracks", 200, client_->Get("/v1/tracks"));
    expect_as_described("getTrackHistory", 200, client_->Get(url + "/history"));
    for (const char* format : {"gpx", "kml"}) {
      expect_as_described("getTrackHistory", 200, client_->Get(url + "/history?format=" + format));
    }
    end_while_listening(url);
  }

  void end_while_listening(const std::string& url) {
    std::atomic<bool> listening = false;
    const std::jthread end([&] {
      EXPECT_TRUE(testing::eventually([&] { return listening.load(); }));
      httplib::Client other = testing::client_of(*service_);
      expect_as_described("endTrack", 204, other.Delete(url));
    });
    std::string events;
    auto answer = client_->Get(url + "/events", [&](const char* data, std::size_t size) {
      events.append(data, size);
      listening = true;
      return true;
    });
    answer->body = events;
    expect_as_described("getTrackEvents", 200, answer);
    const std::string data = events.substr(events.find("data: ") + 6);
    expect_as({{"$ref", "#/components/schemas/StepAnswer"}}, data.substr(0, data.find('\n')), "an event");
  }

  static constexpr std::array kFormats{"global_position_sensor", "command_int", "gps_input", "mavproxy", "nmea"};
  std::set<std::string> given_;
};

TEST_F(ResponseBodies, AreAsTheyAreDescribed) {
  ask_what_is_served();
  ask_for_the_map();
  ask_where_a_picture_is_from();
  fly();
  EXPECT_EQ(given_, described());
}

}  // namespace
}  // namespace roadfix
