#include "server/tracks/track_registry.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <thread>

#include "tests/server/tracks/track_registry_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/eventually.hpp"

namespace roadfix::server {
namespace {

using roadfix::testing::code_of;

using nlohmann::json;

TEST_F(TrackRegistryTest, SaysOfAStepThatWasTakenMeanwhileThatItIsARepeatedOne) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  const auto came = TrackTimes::Clock::now() - std::chrono::seconds(60);
  const StepAnswer first = tracks->step(id, step_of(0), 0, {}, came);
  const StepAnswer again = tracks->step(id, step_of(0), 0, {});
  EXPECT_FALSE(first.repeated);
  EXPECT_TRUE(again.repeated);
  EXPECT_EQ(again.text, first.text);
  EXPECT_EQ(again.answer, json::parse(first.text));
  EXPECT_GE(tracks->times().age_of_step(id, 0), std::chrono::seconds(60));
  tracks->finish(id);
  EXPECT_FALSE(tracks->times().age_of_step(id, 0));
}

TEST_F(TrackRegistryTest, KeepsNothingOfATrackThatEndsWhileItIsAskedFor) {
  const auto tracks = registry();
  const long unused = maps_.find("town").use_count();
  for (int i = 0; i < 50; ++i) {
    const std::string id = begin(*tracks);
    std::atomic<int> asked = 0;
    const std::jthread asks([&] {
      while (code_of([&] { tracks->particles(id, 10); }) == "no error") ++asked;
    });
    while (asked < 10) std::this_thread::yield();
    tracks->finish(id);
  }
  EXPECT_EQ(maps_.find("town").use_count(), unused);
}

TEST_F(TrackRegistryTest, LetsGoOfAMapThatWasReplacedWhenATrackBeginsOnTheNewOne) {
  const auto tracks = registry();
  take(*tracks, begin(*tracks), 0);
  const std::weak_ptr<const ServedMap> before = maps_.find("town");
  std::filesystem::remove(folder_ / "town.gpkg");
  testing::write_map_file(folder_ / "town.gpkg", testing::street_map(4, {2.0, {300'100, -3'200'050}, 300, 300}), 2.0);
  maps_.refresh();
  EXPECT_FALSE(before.expired());  // by the track, which may not fly on it any more
  begin(*tracks);
  EXPECT_TRUE(before.expired());
}

TEST_F(TrackRegistryTest, SearchesByTheCalibrationOfTheService) {
  Calibration doubtful = default_calibration();
  doubtful.highest = 0.5;
  std::mt19937_64 random(1);
  StepInput first = step_of(0);
  first.odometry.reset();
  first.features =
      testing::observed_at(town_, {{600'400.0, 6'399'900.0}, Angle::degrees(40.0)}, 120, 120, 2.0, {}, random);
  const auto accepted = [&](const char* file, std::shared_ptr<const Calibration> calibration) {
    TrackRegistry tracks(folder_ / file, {}, maps_, limits_, std::move(calibration));
    const std::string id = tracks.create("::1", R"({"map": "town", "particles": 500})").id;
    const json answer = tracks.step(id, first, 0, {}).answer;
    EXPECT_EQ(answer["measurement"], "searched");
    return !answer["since_accepted_s"].is_null();
  };
  EXPECT_TRUE(accepted("sure.sqlite", nullptr));
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
}

TEST_F(TrackRegistryTest, ShowsParticlesWhileAStepIsUnderWay) {
  const auto map = maps_.find("town");
  LiveTrack track(map, {});
  std::optional<LiveTrack::Turn> step(std::in_place, track, 0, std::chrono::milliseconds(0));
  step->settle(track.tracker().advance(step->state(), step_of(0)).state);
  auto shown = std::async(std::launch::async, [&] { return track.particles(100).size(); });
  EXPECT_EQ(shown.wait_for(std::chrono::seconds(10)), std::future_status::ready);
  step.reset();
  EXPECT_EQ(shown.get(), 100U);
}

TEST_F(TrackRegistryTest, TakesStepsOfSeveralThreadsInOrder) {
  TrackLimits limits;
  limits.order_wait = std::chrono::minutes(10);
  const auto tracks = registry(limits);
  const std::vector<std::string> expected = undisturbed(40);
  const std::string id = begin(*tracks);
  take(*tracks, id, 0);
  std::atomic<std::int64_t> next = 1;
  std::atomic<int> different = 0;
  std::vector<std::jthread> senders;
  for (int i = 0; i < 4; ++i) {
    senders.emplace_back([&] {
      for (std::int64_t sequence = next++; sequence < 40; sequence = next++) {
        if (take(*tracks, id, sequence) != expected[static_cast<std::size_t>(sequence)]) ++different;
      }
    });
  }
  senders.clear();
  EXPECT_EQ(different, 0);
}

TEST_F(TrackRegistryTest, LetsNoMoreStepsWaitForThoseBeforeThemThanItMay) {
  TrackLimits limits;
  limits.order_wait = std::chrono::minutes(10);
  limits.steps_waiting = 2;
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  take(*tracks, id, 0);
  std::vector<std::jthread> early;
  for (int i = 0; i < 2; ++i) early.emplace_back([&] { tracks->await_predecessor(id, 2); });
  const auto is_busy = [&] { return code_of([&] { tracks->await_predecessor(id, 1); }) == "server-busy"; };
  EXPECT_TRUE(testing::eventually(is_busy));
  take(*tracks, id, 1);
  early.clear();
  EXPECT_FALSE(is_busy());
}

}  // namespace
}  // namespace roadfix::server
