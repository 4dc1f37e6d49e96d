// How tracks outlast the service, and how they end.
#include <gmock/gmock.h>
#include <signal.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "tests/e2e/tracks_fixture.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/sqlite_file.hpp"

namespace roadfix {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::eventually;
using ::testing::HasSubstr;

TEST_F(Tracks, LoseNoAnsweredStepWhenTheServiceIsKilledAtAnyMoment) {
  const std::vector<Request> steps = flight(24);
  const auto without_track = [](const httplib::Result& answer) {
    json body = testing::json_of(answer);
    body.erase("track");
    return body.dump();
  };
  std::vector<std::string> expected;
  {
    const auto undisturbed = service({"--tracks", (folder_ / "undisturbed.sqlite").string()});
    httplib::Client client = client_of(*undisturbed);
    const std::string id = begin(client);
    for (const Request& step : steps) expected.push_back(without_track(send(client, id, step)));
  }
  auto running = service();
  std::string id;
  {
    httplib::Client client = client_of(*running);
    id = begin(client);
  }
  std::vector<std::string> answers;
  std::mt19937_64 random(5);
  while (answers.size() < steps.size()) {
    // After one to four answers, and then at any moment of the next steps. The step that was cut off is sent again: it
    // may have been taken, but must not be taken twice.
    std::atomic<std::size_t> answered = answers.size();
    const std::size_t kill_after = answers.size() + 1 + random() % 4;
    const std::chrono::microseconds moment(random() % 30'000);
    std::jthread killer([&] {
      for (std::size_t now = answered; now < kill_after && now < steps.size(); now = answered) answered.wait(now);
      std::this_thread::sleep_for(moment);
      running->send_signal(SIGKILL);
    });
    httplib::Client client = client_of(*running);
    while (answers.size() < steps.size()) {
      const auto answer = send(client, id, steps[answers.size()]);
      if (!answer) break;
      EXPECT_EQ(answer->status, 200) << answer->body;
      answers.push_back(without_track(answer));
      answered = answers.size();
      answered.notify_one();
    }
    answered = steps.size();
    answered.notify_one();
    killer.join();
    ASSERT_NE(running->wait(10min), -1);
    running = service();
    httplib::Client after = client_of(*running);
    const json track = testing::json_of(after.Get(("/v1/tracks/" + id).c_str()));
    ASSERT_GE(track["last"]["sequence"].get<std::size_t>() + 1, answers.size()) << "an answered step was lost";
  }
  EXPECT_EQ(answers, expected);
}

TEST_F(Tracks, EndEventsInOrderWhenTheServiceStopsAndLimitTheirNumber) {
  const auto running = service({"--max-streams", "1"});
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  std::atomic<bool> connected = false;
  std::string text;
  bool whole = false;
  std::jthread listener([&] {
    httplib::Client other = client_of(*running);
    const auto answer = other.Get(("/v1/tracks/" + id + "/events").c_str(), [&](const char* data, std::size_t size) {
      text.append(data, size);
      connected = true;
      return true;
    });
    whole = static_cast<bool>(answer);
  });
  EXPECT_TRUE(eventually([&] { return connected.load(); }));
  EXPECT_EQ(testing::refusal(client.Get(("/v1/tracks/" + id + "/events").c_str())), "503 server-busy");
  running->send_signal(SIGTERM);
  EXPECT_EQ(running->wait(10min), 0);
  listener.join();
  EXPECT_TRUE(whole) << "the stream ends as a whole answer";
  EXPECT_THAT(text, Not(HasSubstr("event: end"))) << "the track goes on with the next service";
}

TEST_F(Tracks, EndWhenNothingComes) {
  const auto running = service({"--track-idle", "0.2"});
  httplib::Client client = client_of(*running);
  const std::string idle = begin(client);
  EXPECT_TRUE(eventually([&] { return client.Get(("/v1/tracks/" + idle).c_str())->status != 200; }));
  EXPECT_EQ(testing::refusal(client.Get(("/v1/tracks/" + idle).c_str())), "410 track-ended");
  EXPECT_EQ(testing::refusal(send(client, idle, flight(1)[0])), "410 track-ended");
  EXPECT_TRUE(testing::json_of(client.Get("/v1/tracks"))["tracks"].empty());
}

TEST_F(Tracks, TellHowLongTheyWereSilentAndWhenTheyEnd) {
  const std::vector<Request> steps = flight(2);
  std::string id;
  const auto track_of = [&](httplib::Client& client) {
    json track = testing::json_of(client.Get("/v1/tracks/" + id));
    EXPECT_EQ(testing::json_of(client.Get("/v1/tracks"))["tracks"][0]["stale"], track["stale"]);
    return track;
  };
  {
    const auto running = service({"--track-idle", "1000"});
    httplib::Client client = client_of(*running);
    id = begin(client);
    send(client, id, steps[0]);
    EXPECT_TRUE(eventually([&] { return track_of(client)["silent_s"] > 0.05; }));
    const json track = track_of(client);
    EXPECT_NEAR(track["silent_s"].get<double>() + track["expires_in_s"].get<double>(), 1000.0, 1.0);
    EXPECT_EQ(track["stale"], false);
  }
  testing::open_sqlite(folder_ / "tracks.sqlite").execute("UPDATE tracks SET touched_us = touched_us - 61000000");
  const auto running = service({"--track-idle", "1000"});
  httplib::Client client = client_of(*running);
  const json silent = track_of(client);
  EXPECT_GE(silent["silent_s"], 61.0);
  EXPECT_EQ(silent["stale"], true);
  EXPECT_NEAR(silent["expires_in_s"].get<double>(), 1000.0, 60.0) << "all of it again";
  send(client, id, steps[1]);
  EXPECT_EQ(track_of(client)["stale"], false);
}

TEST_F(Tracks, CountTheTimeThatAStepTookToArriveToItsAge) {
  const Request step = flight(1)[0];
  const auto running = service();
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  EXPECT_FALSE(testing::json_of(client.Get("/v1/tracks/" + id)).contains("last_age_s"));
  const auto slowly = [&](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
    std::this_thread::sleep_for(1s);
    return sink.write(step.picture.data() + offset, length);
  };
  EXPECT_EQ(client.Post("/v1/tracks/" + id + "/steps" + step.query, step.picture.size(), slowly, "image/png")->status,
            200);
  const json track = testing::json_of(client.Get("/v1/tracks/" + id));
  EXPECT_GE(track["last_age_s"].get<double>() - track["silent_s"].get<double>(), 0.9);
}

TEST_F(Tracks, RefuseStepsOverAMapThatWasReplaced) {
  const auto running = service();
  httplib::Client client = client_of(*running);
  const std::string id = begin(client);
  const std::string version = testing::json_of(client.Get("/v1/maps/town"))["version"];
  {
    MapWriter writer(folder_ / "town.gpkg", {town_.zone, 2.0});
    writer.remove_source("town");
  }
  EXPECT_TRUE(eventually([&] { return testing::json_of(client.Get("/v1/maps/town"))["version"] != version; }));
  EXPECT_EQ(testing::refusal(send(client, id, flight(1)[0])), "409 map-replaced");
  const json track = testing::json_of(client.Get(("/v1/tracks/" + id).c_str()));
  EXPECT_FALSE(track.contains("last")) << "nothing was taken";
}

TEST_F(Tracks, SayWhyTheyCannotBeKeptWhileMapsAreServed) {
  std::ofstream(folder_ / "broken.sqlite") << std::string(4096, 'x');
  const auto refusal_with = [&](const std::string& store) {
    const auto running = service({"--tracks", store});
    httplib::Client client = client_of(*running);
    EXPECT_EQ(client.Get("/v1/maps/town")->status, 200);
    const json ready = testing::json_of(client.Get("/readyz"));
    EXPECT_EQ(ready["status"], "ready");
    EXPECT_EQ(ready["tracks"], "unavailable");
    EXPECT_THAT(ready["tracks_problem"].get<std::string>(), HasSubstr(store));
    return testing::refusal(client.Post("/v1/tracks", asked().dump(), "application/json"));
  };
  EXPECT_EQ(refusal_with((folder_ / "broken.sqlite").string()), "503 track-store-corrupt");
  EXPECT_EQ(refusal_with((folder_ / "no/such/folder.sqlite").string()), "503 track-store-unavailable");
}

TEST_F(Tracks, FlySixteenVehiclesAtOnce) {
  const auto running = service();
  const std::vector<Request> steps = flight(6);
  std::atomic<int> converged = 0;
  std::vector<std::jthread> vehicles;
  for (int i = 0; i < 16; ++i) {
    vehicles.emplace_back([&] {
      httplib::Client client = client_of(*running);
      const std::string id = begin(client);
      json last;
      for (const Request& step : steps) last = testing::json_of(send(client, id, step));
      if (last["status"] == "converged") ++converged;
    });
  }
  vehicles.clear();
  EXPECT_EQ(converged, 16);
}

}  // namespace
}  // namespace roadfix
