// Tracks as a client meets them: flights over real sockets.
#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "tests/e2e/tracks_fixture.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_http.hpp"

namespace roadfix {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::eventually;
using ::testing::HasSubstr;

TEST_F(Tracks, FollowAFlightAndTellItsHistory) {
  const auto running = service();
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  EXPECT_FALSE(testing::json_of(client.Get(("/v1/tracks/" + id).c_str())).contains("last")) << "no step yet";
  testing::Flight flight(town_.roads, town_.pose, 20);
  json answer;
  for (int i = 0; i < 8; ++i) answer = testing::json_of(send(client, id, request_of(flight.step())));
  ASSERT_EQ(answer["status"], "converged") << answer;
  const GridPoint found = town_.zone.project({answer["pose"]["lat"], answer["pose"]["lon"]});
  EXPECT_LT(distance_m(found, flight.pose().position), 12.0);

  const json track = testing::json_of(client.Get(("/v1/tracks/" + id + "?particles=100").c_str()));
  EXPECT_EQ(track["last"], answer);
  EXPECT_EQ(track["request"]["seed"], 7);
  EXPECT_GT(track["particles"].size(), 50U);
  EXPECT_LE(track["particles"].size(), 100U);
  EXPECT_EQ(testing::json_of(client.Get("/v1/tracks"))["tracks"][0]["id"], id);

  const json history = testing::json_of(client.Get(("/v1/tracks/" + id + "/history").c_str()));
  EXPECT_EQ(history["type"], "FeatureCollection");
  EXPECT_EQ(history["map"], answer["map"]);
  EXPECT_EQ(history["features"].size(), 9U) << "eight points and the line";
  EXPECT_EQ(history["features"][8]["geometry"]["type"], "LineString");
  EXPECT_EQ(testing::json_of(client.Get(("/v1/tracks/" + id + "/history?after=5").c_str()))["features"].size(), 3U);
  EXPECT_EQ(testing::json_of(client.Get(("/v1/tracks/" + id + "/history?after=4294967296").c_str()))["features"],
            json::array());
  for (const auto& [name, type] :
       {std::pair("gpx", "application/gpx+xml"), std::pair("kml", "application/vnd.google-earth.kml+xml")}) {
    const auto file = client.Get(("/v1/tracks/" + id + "/history?format=" + name).c_str());
    EXPECT_EQ(file->get_header_value("Content-Type"), type);
    EXPECT_THAT(file->body, HasSubstr("</" + std::string(name) + ">"));
    const auto negotiated = client.Get(("/v1/tracks/" + id + "/history").c_str(), {{"Accept", type}});
    EXPECT_EQ(negotiated->body, file->body);
  }
}

TEST_F(Tracks, GoOnWhileSearchesHaveAllTurns) {
  const auto running = service({"--searches", "1", "--turn-time", "0.1"});
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::vector<Request> steps = flight(2);
  ASSERT_EQ(send(client, id, steps[0])->status, 200);
  const std::string body = town_.seen_from(town_.pose, 60);
  testing::RawConnection search(running->port());
  search.send(
      "POST /v1/maps/town/fix?cell_m=2&scale_range=0.3&proof_s=600 HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
      "image/png\r\nContent-Length: " +
      std::to_string(body.size()) + "\r\n\r\n" + body);
  EXPECT_TRUE(
      eventually([&] { return client.Get("/metrics")->body.find("roadfix_heavy_running 1\n") != std::string::npos; }));
  EXPECT_EQ(testing::refusal(client.Post("/v1/maps/town/fix?cell_m=2", body, "image/png")), "503 server-busy");
  EXPECT_EQ(send(client, id, steps[1])->status, 200);
}

TEST_F(Tracks, AnswerARepeatedStepAgainAndRefuseOthers) {
  const auto running = service();
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::vector<Request> steps = flight(4);
  send(client, id, steps[0]);
  const auto first = send(client, id, steps[1]);
  const auto again = send(client, id, steps[1]);
  EXPECT_EQ(again->body, first->body);
  EXPECT_EQ(again->get_header_value("Roadfix-Repeated"), "true");
  EXPECT_EQ(testing::refusal(send(client, id, {steps[1].query, steps[2].picture})), "409 step-differs");
  send(client, id, steps[3]);
  EXPECT_EQ(testing::json_of(client.Get(("/v1/tracks/" + id).c_str()))["last"]["missed_steps"], 1);
  EXPECT_EQ(testing::refusal(send(client, id, steps[2])), "409 step-late");
  EXPECT_EQ(testing::refusal(send(client, id, {steps[2].query, "no picture"})), "409 step-late")
      << "before its picture is looked at";

  const auto refused = [&](const json& step) {
    return testing::refusal(client.Post(("/v1/tracks/" + id + "/steps").c_str(), step.dump(), "application/json"));
  };
  EXPECT_EQ(refused({{"sequence", 9}, {"time_us", 9'000'000'000}, {"also", json::array()}}), "400 unknown-field also")
      << "a track lays its frames together itself";
  EXPECT_EQ(refused({{"sequence", 4}, {"time_us", 4'000'000}}), "409 time-backwards");
  EXPECT_EQ(refused({{"sequence", 4}}), "400 missing-parameter time_us");
  EXPECT_EQ(refused({{"sequence", 4.5}, {"time_us", 1}}), "400 bad-parameter sequence");
  EXPECT_EQ(refused({{"sequence", 4}, {"time_us", 9'000'000}, {"forward_m", 3}}), "400 missing-parameter right_m");
  EXPECT_EQ(testing::refusal(send(client, id, {"?sequence=4&time_us=9000000&cell_m=2", ""})),
            "400 missing-parameter image")
      << "a picture that was lost on its way";
  EXPECT_EQ(refused({{"sequence", 4}, {"time_us", 9'000'000}, {"cell_m", 2}, {"image", ""}}),
            "400 missing-parameter image");
  EXPECT_EQ(refused({{"sequence", 4}, {"time_us", 9'000'000}, {"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 300}}),
            "400 missing-parameter image")
      << "a picture that was forgotten";
  json bad{{"sequence", 4}, {"time_us", 9'000'000}, {"forward_m", 3}, {"right_m", 0}, {"turn_deg", 0}};
  bad["covariance"] = {1, 2, 0, 2, 1, 0, 0, 0, 1};
  EXPECT_EQ(refused(bad), "422 covariance-not-positive");
  bad["covariance"] = {1, 2, 0};
  EXPECT_EQ(refused(bad), "400 bad-parameter covariance");
  EXPECT_EQ(
      testing::refusal(client.Post(("/v1/tracks/" + id + "/steps").c_str(),
                                   R"({"sequence": 4, "time_us": 9000000, "forward_m": NaN})", "application/json")),
      "400 bad-json body");
  EXPECT_EQ(
      client
          .Post(("/v1/tracks/" + id + "/steps").c_str(), R"({"sequence": 4, "time_us": 9000000})", "application/json")
          ->status,
      200)
      << "dead reckoning, after all that was refused";

  EXPECT_EQ(client.Delete(("/v1/tracks/" + id).c_str())->status, 204);
  EXPECT_EQ(testing::refusal(send(client, id, steps[3])), "410 track-ended");
  EXPECT_EQ(testing::refusal(send(client, "nobody", steps[0])), "404 track-not-found");
}

TEST_F(Tracks, KnowARepeatedStepHoweverItIsPacked) {
  const auto running = service();
  httplib::Client client = client_of(*running);
  const std::string path = "/v1/tracks/" + begin(client) + "/steps";
  const auto posted = [&](const std::string& body, const std::string& type) {
    return client.Post(path.c_str(), body, type.c_str());
  };
  const auto form = [&](const std::string& boundary) {
    const auto part = [&](const std::string& name, const std::string& value) {
      return "--" + boundary + "\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\n" + value + "\r\n";
    };
    const std::string picture = flight(1).front().picture;
    return posted(part("sequence", "0") + part("time_us", "1000000") + part("cell_m", "2") + part("image", picture) +
                      "--" + boundary + "--\r\n",
                  "multipart/form-data; boundary=" + boundary);
  };
  const std::string first = form("one")->body;
  EXPECT_EQ(form("another")->body, first);
  EXPECT_EQ(posted(R"({"sequence": 1, "time_us": 2000000, "format": "nmea"})", "application/json")->status, 200);
  const auto again = posted(R"({"time_us": 2000000, "sequence": 1, "format": "mavproxy"})", "application/json");
  EXPECT_EQ(testing::json_of(again)["fix_type"], 1) << again->body;
  EXPECT_EQ(again->get_header_value("Roadfix-Repeated"), "true");
  EXPECT_EQ(testing::refusal(posted(R"({"sequence": 1, "time_us": 2000001})", "application/json")), "409 step-differs");
}

TEST_F(Tracks, DoNotTellBackWhatWasNotGiven) {
  const auto running = service();
  httplib::Client client = client_of(*running);
  json body = asked();
  body.update({{"wind_sigma_m_s", nullptr}, {"bbox", nullptr}});
  const json begun = testing::json_of(client.Post("/v1/tracks", body.dump(), "application/json"));
  EXPECT_EQ(begun["request"], asked());
  const std::string path = "/v1/tracks/" + begun["id"].get<std::string>();
  EXPECT_EQ(testing::json_of(client.Get(path.c_str()))["request"], asked());
}

TEST_F(Tracks, RefuseToBeginWhatCannotBe) {
  const auto running = service({"--max-client-tracks", "1"});
  httplib::Client client = client_of(*running);
  const auto refused = [&](const json& change) {
    json body = asked();
    body.update(change);
    return testing::refusal(client.Post("/v1/tracks", body.dump(), "application/json"));
  };
  EXPECT_EQ(refused({{"map", "nowhere"}}), "404 map-not-found");
  EXPECT_EQ(refused({{"map", std::string(100'000, 'x')}}), "413 json-too-long");
  EXPECT_EQ(refused({{"lat", 10.0}, {"lon", 20.0}}), "422 prior-outside-map");
  EXPECT_EQ(refused({{"filter", "paper"}}), "400 unknown-field filter");
  EXPECT_EQ(refused({{"particles", 1'000'000'000}}), "400 parameter-out-of-range particles");
  EXPECT_EQ(refused({{"color", 1}}), "400 unknown-field color");
  for (const char* without_speed : {"speed_sigma_m_s", "turn_rate_deg_s", "turn_rate_sigma_deg_s"}) {
    EXPECT_EQ(refused({{without_speed, 1}}), "400 missing-parameter speed_m_s") << without_speed;
  }
  begin(client);
  EXPECT_EQ(refused(json::object()), "429 too-many-tracks");
}

TEST_F(Tracks, PutStepsThatOvertakeEachOtherInOrder) {
  const auto running = service({"--searches", "1", "--step-wait", "600"});
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::vector<Request> steps = flight(5);
  send(client, id, steps[0]);
  std::vector<std::jthread> overtaking;
  std::atomic<int> missed = 0;
  for (const std::size_t i : {4U, 3U, 2U}) {
    overtaking.emplace_back([&, i] {
      httplib::Client other = client_of(*running);
      missed += testing::json_of(send(other, id, steps[i]))["missed_steps"].get<int>();
    });
  }
  EXPECT_EQ(send(client, id, steps[1])->status, 200);
  overtaking.clear();
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(testing::json_of(client.Get(("/v1/tracks/" + id).c_str()))["last"]["sequence"], 4);
}

TEST_F(Tracks, TakeAStepThatComesManyTimesAtOnceOnlyOnce) {
  const auto running = service({"--searches", "8"});
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::vector<Request> steps = flight(2);
  send(client, id, steps[0]);
  std::vector<std::string> answers(6);
  std::vector<std::jthread> senders;
  for (std::string& answer : answers) {
    senders.emplace_back([&] {
      httplib::Client other = client_of(*running);
      answer = send(other, id, steps[1])->body;
    });
  }
  senders.clear();
  EXPECT_THAT(answers, ::testing::Each(answers[0]));
  EXPECT_EQ(json::parse(answers[0])["sequence"], 1);
}

TEST_F(Tracks, SendEventsAsTheyHappenAndFromWhereTheClientLeft) {
  const auto running = service();
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::vector<Request> steps = flight(3);
  send(client, id, steps[0]);
  const auto listen = [&](const httplib::Headers& headers, std::atomic<bool>& connected) {
    httplib::Client other = client_of(*running);
    std::string text;
    const auto receive = [&](const char* data, std::size_t size) {
      text.append(data, size);
      connected = true;
      return true;
    };
    const auto answer = other.Get(("/v1/tracks/" + id + "/events").c_str(), headers, receive);
    EXPECT_TRUE(answer && answer->get_header_value("X-Accel-Buffering") == "no") << "nginx would hold events back";
    return text;
  };
  std::atomic<bool> connected = false;
  std::atomic<bool> resumed = false;
  std::string all;
  std::string rest;
  std::jthread whole([&] { all = listen({{"Accept-Encoding", "gzip"}}, connected); });
  EXPECT_TRUE(eventually([&] { return connected.load(); }));
  const std::string second = send(client, id, steps[1])->body;
  std::jthread tail([&] { rest = listen({{"Last-Event-ID", "0"}}, resumed); });
  EXPECT_TRUE(eventually([&] { return resumed.load(); }));
  client.Delete(("/v1/tracks/" + id).c_str());
  whole.join();
  tail.join();
  EXPECT_THAT(all, HasSubstr("id: 0\nevent: step\ndata: {"));
  EXPECT_THAT(all, HasSubstr("id: 1\nevent: step\ndata: " + second + "\n\n"));
  EXPECT_THAT(rest, HasSubstr("id: 1\nevent: step\ndata: " + second + "\n\n"));
  EXPECT_THAT(rest, Not(HasSubstr("id: 0\n")));
  EXPECT_THAT(rest, HasSubstr("event: end\ndata: {\"reason\":\"finished\"}\n"));
}

TEST_F(Tracks, AnswerInTheWordsOfAutopilots) {
  const auto running = service();
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::vector<Request> steps = flight(8);
  const auto as = [&](std::size_t step, const std::string& how, const httplib::Headers& headers = {}) {
    const std::string path = "/v1/tracks/" + id + "/steps" + steps[step].query + how;
    return client.Post(path.c_str(), headers, steps[step].picture, "image/png");
  };
  const auto nothing = as(0, "&format=global_position_sensor");
  EXPECT_EQ(nothing->status, 204) << "not yet converged";
  EXPECT_EQ(nothing->get_header_value("Roadfix-Status"), "searching");
  EXPECT_EQ(testing::json_of(as(0, "&format=mavproxy"))["fix_type"], 1);
  EXPECT_EQ(testing::refusal(as(1, "&format=morse")), "400 bad-parameter format");
  EXPECT_EQ(testing::refusal(as(1, "", {{"Accept", "text/html"}})), "406 not-acceptable");
  for (std::size_t i = 1; i < steps.size(); ++i) send(client, id, steps[i]);
  const json pose = testing::json_of(send(client, id, steps[7]))["pose"];
  const auto told = as(7, "&alt_m=512", {{"Accept", "application/x-mavproxy-gps-input+json"}});
  EXPECT_EQ(told->get_header_value("Roadfix-Repeated"), "true") << "the words do not make it another step";
  const json input = testing::json_of(told);
  EXPECT_NEAR(1e-7 * input["lat"].get<double>(), pose["lat"].get<double>(), 1e-7);
  EXPECT_NEAR(1e-7 * input["lon"].get<double>(), pose["lon"].get<double>(), 1e-7);
  EXPECT_EQ(input["fix_type"], 3);
  EXPECT_EQ(input["time_usec"], 8'000'000);
  const double heading_deg = pose["heading_deg"];
  EXPECT_NEAR(input["yaw"].get<double>(), 100.0 * heading_deg, 1.0);
  const json turned = testing::json_of(as(7, "&format=mavproxy&camera_yaw_deg=" + std::to_string(heading_deg - 20.0)));
  EXPECT_NEAR(turned["yaw"].get<double>(), 2000.0, 1.0) << "the vehicle's: the camera is turned in it by the rest";
  const std::string packet = as(7, "&format=gps_input&system=7")->body;
  EXPECT_EQ(packet.substr(0, 1), "\xfd");
  EXPECT_EQ(packet.substr(4, 3), std::string("\x07\x07\xc5")) << "sequence, system, component";
  EXPECT_THAT(as(7, "&format=nmea")->body, ::testing::StartsWith("$GPGGA,,"));
}

TEST_F(Tracks, TellAutopilotsHowOldTheAnswerToARepeatedStepIs) {
  auto running = service();
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::vector<Request> steps = flight(9);
  const auto again = [&](httplib::Client& from, std::size_t step) {
    return send(from, id, {steps[step].query + "&format=global_position_sensor", steps[step].picture});
  };
  const auto number = [](const std::string& packet, std::size_t begin, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | static_cast<unsigned char>(packet.at(begin + i));
    return value;
  };
  for (std::size_t i = 0; i < 8; ++i) send(client, id, steps[i]);
  std::this_thread::sleep_for(300ms);
  for (const bool is_last : {true, false}) {
    const std::string packet = again(client, 7)->body;
    constexpr std::size_t kHeader = 10;
    const std::uint64_t sent_us = number(packet, kHeader, 8);
    const std::uint64_t processing_us = number(packet, kHeader + 8, 4);
    EXPECT_GE(processing_us, is_last ? 300'000U : 600'000U) << "since it came first, however soon it is answered again";
    EXPECT_LT(processing_us, 20'000'000U);
    EXPECT_EQ(sent_us - processing_us, 8'000'000U) << "the time of the frame";
    std::this_thread::sleep_for(300ms);
    if (is_last) send(client, id, steps[8]);
  }

  running.reset();
  running = service();
  httplib::Client later = client_of(*running);
  EXPECT_EQ(again(later, 8)->status, 204) << "nobody knows how old it is";
  EXPECT_EQ(testing::json_of(send(later, id, steps[8]))["status"], "converged");
}

}  // namespace
}  // namespace roadfix
