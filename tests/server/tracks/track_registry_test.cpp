#include "server/tracks/track_registry.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <vector>

#include "tests/server/tracks/track_registry_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::server {
namespace {

using roadfix::testing::code_of;

using nlohmann::json;

TEST_F(TrackRegistryTest, KeepsNothingOfATrackThatEndsWhileItIsAskedFor) {
  const auto tracks = registry();
  for (int i = 0; i < 50; ++i) {
    const std::string id = begin(*tracks);
    std::atomic<int> asked = 0;
    const std::jthread asks([&] {
      while (code_of([&] { tracks->live(id)->particles(10); }) == "no error") ++asked;
    });
    while (asked < 10) std::this_thread::yield();
    tracks->finish(id);
  }
  const std::weak_ptr<const ServedMap> map = maps_.find("town");
  std::filesystem::remove(folder_ / "town.gpkg");
  maps_.refresh();
  EXPECT_TRUE(map.expired());
}

TEST_F(TrackRegistryTest, LetsGoOfAMapThatWasReplacedUnlessAStepIsTakenOnIt) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  take(*tracks, id, 0);
  auto step = tracks->live(id);
  const std::weak_ptr<const ServedMap> before = maps_.find("town");
  std::filesystem::remove(folder_ / "town.gpkg");
  testing::write_map_file(folder_ / "town.gpkg", testing::street_map(4, {2.0, {300'100, -3'200'050}, 300, 300}), 2.0);
  maps_.refresh();
  tracks->tidy();
  EXPECT_FALSE(before.expired());
  step.reset();
  tracks->tidy();
  EXPECT_TRUE(before.expired());
  EXPECT_EQ(code_of([&] { tracks->live(id); }), "map-replaced");
}

TEST_F(TrackRegistryTest, GoesOnWithAMapThatWasCopiedOverAsIfNothingHadHappened) {
  const std::vector<std::string> expected = undisturbed(2);
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  EXPECT_EQ(take(*tracks, id, 0), expected[0]);
  std::filesystem::copy_file(folder_ / "town.gpkg", folder_ / "copy");
  std::filesystem::rename(folder_ / "copy", folder_ / "town.gpkg");
  const std::weak_ptr<const ServedMap> before = maps_.find("town");
  maps_.refresh();
  tracks->tidy();
  EXPECT_TRUE(before.expired());
  EXPECT_EQ(take(*tracks, id, 1), expected[1]);
}

TEST_F(TrackRegistryTest, LetsGoOfWhatHasExpiredThoughNobodyAsksForATrack) {
  TrackLimits limits;
  limits.idle = std::chrono::milliseconds(-1);  // at once
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  ASSERT_NE(tracks->in_memory(id), nullptr);
  tracks->tidy();
  EXPECT_EQ(tracks->in_memory(id), nullptr);
}

TEST_F(TrackRegistryTest, SearchesByTheCalibrationOfTheService) {
  Calibration doubtful = *shipped_calibration();
  doubtful.highest = 0.5;
  std::mt19937_64 random(1);
  StepInput first = step_of(0);
  first.odometry.reset();
  first.features =
      testing::observed_at(town_, {{600'400.0, 6'399'900.0}, Angle::degrees(40.0)}, 120, 120, 2.0, {}, random);
  const auto accepted = [&](const char* file, std::shared_ptr<const Calibration> calibration) {
    TrackRegistry tracks(folder_ / file, {}, maps_, limits_, std::move(calibration));
    const std::string id = tracks.create("::1", R"({"map": "town", "particles": 500})").id;
    const json answer = TrackSteps(tracks).take(id, sent(first), {}).answer;
    EXPECT_EQ(answer["measurement"], "searched");
    return !answer["since_accepted_s"].is_null();
  };
  EXPECT_TRUE(accepted("sure.sqlite", shipped_calibration()));
  EXPECT_FALSE(accepted("doubtful.sqlite", std::make_shared<const Calibration>(doubtful)));
}

TEST_F(TrackRegistryTest, LimitsTheTracksOfAClientAndOfAll) {
  TrackLimits limits;
  limits.tracks = 3;
  limits.tracks_per_client = 2;
  const auto tracks = registry(limits);
  const std::string first = begin(*tracks, "a");
  begin(*tracks, "a");
  EXPECT_EQ(code_of([&] { begin(*tracks, "a"); }), "too-many-tracks");
  begin(*tracks, "b");
  EXPECT_EQ(code_of([&] { begin(*tracks, "c"); }), "too-many-tracks");
  tracks->finish(first);
  EXPECT_EQ(code_of([&] { begin(*tracks, "c"); }), "no error");
  EXPECT_EQ(tracks->of_client("a").size(), 1U);
}

TEST_F(TrackRegistryTest, EndsTracksThatAreSilentForTooLong) {
  TrackLimits limits;
  limits.idle = std::chrono::milliseconds(-1);  // at once
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  EXPECT_EQ(code_of([&] { tracks->find(id); }), "track-ended");
  EXPECT_EQ(code_of([&] { take(*tracks, id, 0); }), "track-ended");
  EXPECT_EQ(code_of([&] { tracks->stream(id, -1); }), "track-ended");
  EXPECT_TRUE(tracks->of_client("::1").empty());
  EXPECT_EQ(tracks->flying(), 0U);
}

TEST_F(TrackRegistryTest, ShowsWhatAnExpiredTrackFlewUntilItIsDeleted) {
  const std::string id = [&] {
    const auto tracks = registry();
    std::string flown = begin(*tracks);
    take(*tracks, flown, 0);
    return flown;
  }();
  TrackLimits limits;
  limits.idle = std::chrono::milliseconds(-1);  // at once
  const auto tracks = registry(limits);
  for (const bool tidied : {false, true}) {
    if (tidied) tracks->tidy();
    EXPECT_EQ(code_of([&] { tracks->find(id); }), "track-ended");
    EXPECT_EQ(tracks->recorded(id).map.name, "town");
    EXPECT_EQ(tracks->steps_after(id, -1, 10).size(), 1U);
  }
  tracks->finish(id);
  EXPECT_EQ(code_of([&] { tracks->steps_after(id, -1, 10); }), "track-ended");
  EXPECT_EQ(code_of([&] { tracks->finish(id); }), "track-ended");
}

TEST_F(TrackRegistryTest, EndsNoTrackThatHasJustBegunInAnOldService) {
  TrackLimits limits;
  limits.idle = std::chrono::seconds(2);
  const auto tracks = registry(limits);
  std::this_thread::sleep_for(limits.idle);
  std::atomic<int> lost = 0;
  std::vector<std::jthread> clients;
  for (int client = 0; client < 4; ++client) {
    clients.emplace_back([&, name = std::to_string(client)] {
      for (int i = 0; i < 100; ++i) {
        const auto began = std::chrono::steady_clock::now();
        const std::string id = begin(*tracks, name);
        const std::string code = code_of([&] { tracks->finish(id); });
        if (code != "no error" && std::chrono::steady_clock::now() - began < limits.idle) ++lost;
      }
    });
  }
  clients.clear();
  EXPECT_EQ(lost, 0);
}

TEST_F(TrackRegistryTest, DoesNotEndATrackWhileItTakesAStep) {
  TrackLimits limits;
  limits.idle = std::chrono::seconds(1);
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  auto step = tracks->live(id);
  const TrackerState state = step->tracker().advance({}, step_of(0)).state;
  std::this_thread::sleep_for(limits.idle + std::chrono::milliseconds(100));
  begin(*tracks);
  EXPECT_EQ(code_of([&] { tracks->store_step(id, {0, 0, "{}"}, state); }), "no error");
  step.reset();
  begin(*tracks);
  EXPECT_EQ(code_of([&] { tracks->store_step(id, {1, 0, "{}"}, state); }), "track-ended");
}

}  // namespace
}  // namespace roadfix::server
