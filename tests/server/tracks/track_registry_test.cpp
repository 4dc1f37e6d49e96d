#include "server/tracks/track_registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

#include "tests/support/code_of.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/sqlite_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::server {
namespace {

using roadfix::testing::code_of;

using nlohmann::json;

/// Dead reckoning: what a track is kept for does not depend on what was seen.
StepInput step_of(std::int64_t sequence) {
  StepInput step;
  step.sequence = sequence;
  step.time_us = 1'000'000 * (sequence + 1);
  step.odometry = Odometry{20.0, 0.5, Angle::degrees(3.0)};
  return step;
}

class TrackRegistryTest : public ::testing::Test {
 protected:
  TrackRegistryTest() {
    testing::write_map_file(folder_ / "town.gpkg", town_, 2.0);
    maps_.refresh();
  }

  std::unique_ptr<TrackRegistry> registry(const TrackLimits& limits = {}, const char* file = "tracks.sqlite") const {
    return std::make_unique<TrackRegistry>(folder_ / file, limits, maps_, limits_);
  }
  static std::string begin(TrackRegistry& tracks, const std::string& client = "::1") {
    return tracks.create(client, R"({"map": "town", "particles": 500, "start": "uniform", "seed": 9})").id;
  }
  /// The answer without the name of the track.
  static std::string take(TrackRegistry& tracks, const std::string& id, std::int64_t sequence) {
    json answer = json::parse(tracks.step(id, step_of(sequence), sequence, {}));
    answer.erase("track");
    return answer.dump();
  }
  std::vector<std::string> undisturbed(int steps) const {
    const auto tracks = registry({}, "undisturbed.sqlite");
    const std::string id = begin(*tracks);
    std::vector<std::string> answers;
    for (int i = 0; i < steps; ++i) answers.push_back(take(*tracks, id, i));
    return answers;
  }

  const RoadGrid town_ = testing::street_map(3, {2.0, {300'100, -3'200'050}, 300, 300});
  const testing::TemporaryFolder folder_;
  const api::Limits limits_;
  MapRegistry maps_{folder_.path(), 1 << 20};
};

TEST_F(TrackRegistryTest, GoesOnAfterARestartAsWithoutOne) {
  const std::vector<std::string> expected = undisturbed(6);
  std::string id;
  for (int i = 0; i < 6; ++i) {
    const auto tracks = registry();
    if (i == 0) id = begin(*tracks);
    EXPECT_EQ(take(*tracks, id, i), expected[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(registry()->steps_after(id, -1, 100).size(), 6U);
}

TEST_F(TrackRegistryTest, SaysAfterARestartHowLongATrackHasBeenSilentWithoutEndingIt) {
  TrackLimits limits;
  limits.idle = std::chrono::seconds(60);
  const std::string id = begin(*registry());
  take(*registry(), id, 0);
  testing::open_sqlite(folder_ / "tracks.sqlite").execute("UPDATE tracks SET touched_us = touched_us - 100000000");
  const auto tracks = registry(limits);
  EXPECT_GE(tracks->silent(tracks->find(id)), std::chrono::seconds(100));
  EXPECT_LT(tracks->idle(id), limits.idle);
  take(*tracks, id, 1);
  EXPECT_LT(tracks->silent(tracks->find(id)), limits.idle);
}

TEST_F(TrackRegistryTest, KnowsHowOldEachOfTheLastStepsIs) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  const auto came = [](int seconds_ago) {
    return std::chrono::steady_clock::now() - std::chrono::seconds(seconds_ago);
  };
  EXPECT_FALSE(tracks->age_of_step(id, 0));
  tracks->step(id, step_of(0), 0, {}, came(60));
  tracks->step(id, step_of(1), 1, {}, came(30));
  tracks->step(id, step_of(0), 0, {}, came(20));  // again
  EXPECT_NEAR(std::chrono::duration<double>(tracks->age_of_step(id, 0).value()).count(), 60.0, 9.0);
  EXPECT_NEAR(std::chrono::duration<double>(tracks->age_of_step(id, 1).value()).count(), 30.0, 9.0);
  EXPECT_FALSE(tracks->age_of_step(id, 2));
  const auto last = static_cast<std::int64_t>(TrackRegistry::kAged);
  for (std::int64_t i = 2; i <= last; ++i) take(*tracks, id, i);
  EXPECT_FALSE(tracks->age_of_step(id, 0));
  EXPECT_TRUE(tracks->age_of_step(id, 1));
  EXPECT_TRUE(tracks->age_of_step(id, last));
  tracks->finish(id);
  EXPECT_FALSE(tracks->age_of_step(id, last));
}

TEST_F(TrackRegistryTest, DoesNotKnowHowOldAStepFromBeforeARestartIs) {
  const std::string id = begin(*registry());
  take(*registry(), id, 0);
  const auto tracks = registry();
  EXPECT_FALSE(tracks->age_of_step(id, 0));
  take(*tracks, id, 1);
  EXPECT_FALSE(tracks->age_of_step(id, 0));
  EXPECT_TRUE(tracks->age_of_step(id, 1));
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

TEST_F(TrackRegistryTest, IsAsItWasAfterAStepThatTheFullStoreRefused) {
  const std::vector<std::string> expected = undisturbed(100);
  TrackLimits limits;
  limits.store_bytes = 120 << 10;
  const auto tracks = registry(limits);
  const std::string other = begin(*tracks);
  const std::string id = begin(*tracks);
  take(*tracks, other, 0);
  std::size_t next = 0;
  std::string refusal;
  for (; refusal.empty() && next < expected.size(); ++next) {
    refusal = code_of([&] { EXPECT_EQ(take(*tracks, id, static_cast<std::int64_t>(next)), expected[next]); });
    if (refusal == "no error") refusal.clear();
  }
  ASSERT_EQ(refusal, "track-store-full");
  const auto refused = static_cast<std::int64_t>(next - 1);
  EXPECT_EQ(tracks->last_step(id)->sequence, refused - 1);
  EXPECT_THAT(tracks->problem(), ::testing::Optional(::testing::HasSubstr("no space left")));
  tracks->finish(other);
  EXPECT_EQ(take(*tracks, id, refused), expected[next - 1]);
  EXPECT_FALSE(tracks->problem());
}

TEST_F(TrackRegistryTest, SaysThatTheStoredStateIsDamaged) {
  const std::string id = [&] {
    const auto tracks = registry();
    std::string begun = begin(*tracks);
    take(*tracks, begun, 0);
    return begun;
  }();
  const auto damaged_by = [&](const char* sql) {
    std::filesystem::copy_file(folder_ / "tracks.sqlite", folder_ / "damaged.sqlite",
                               std::filesystem::copy_options::overwrite_existing);
    testing::open_sqlite(folder_ / "damaged.sqlite").execute(sql);
    const auto tracks = registry({}, "damaged.sqlite");
    EXPECT_EQ(code_of([&] { (void)tracks->find(id); }), "no error") << "it can still be ended";
    return code_of([&] { take(*tracks, id, 1); });
  };
  EXPECT_EQ(damaged_by("UPDATE tracks SET particles = zeroblob(200)"), "filter-state-corrupt");
  EXPECT_EQ(damaged_by("UPDATE tracks SET frames = zeroblob(64)"), "track-frames-corrupt");
  EXPECT_EQ(damaged_by("UPDATE tracks SET counters = '{'"), "track-store-corrupt");
  EXPECT_EQ(damaged_by("UPDATE tracks SET counters = '{}'"), "track-store-corrupt");
  EXPECT_EQ(damaged_by("UPDATE tracks SET request = 'nothing'"), "track-store-corrupt");
}

TEST_F(TrackRegistryTest, KeepsTracksAsSoonAsTheStoreCanBeOpened) {
  const auto tracks = registry({}, "later/tracks.sqlite");
  EXPECT_TRUE(tracks->problem());
  EXPECT_EQ(code_of([&] { begin(*tracks); }), "track-store-unavailable");
  std::filesystem::create_directory(folder_ / "later");
  EXPECT_FALSE(tracks->problem());
  EXPECT_EQ(code_of([&] { begin(*tracks); }), "no error");
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
    const json answer = json::parse(tracks.step(id, first, 0, {}));
    EXPECT_EQ(answer["measurement"], "searched");
    return !answer["since_accepted_s"].is_null();
  };
  EXPECT_TRUE(accepted("sure.sqlite", nullptr));
  EXPECT_FALSE(accepted("doubtful.sqlite", std::make_shared<const Calibration>(doubtful)));
}

TEST_F(TrackRegistryTest, SearchesOverTheSameFramesAfterARestart) {
  // Of another town, so that the track is never placed: its eleventh frame is searched with those before it.
  const RoadGrid elsewhere = testing::street_map(99, town_.geometry);
  const auto flight = [&](const char* file, bool restarts) {
    std::mt19937_64 random(3);
    auto tracks = registry({}, file);
    const std::string id = tracks->create("::1", R"({"map": "town", "particles": 500, "seed": 9})").id;
    std::vector<std::string> answers;
    for (int i = 0; i < 12; ++i) {
      StepInput step = step_of(i);
      step.features = testing::observed_at(elsewhere, {{600'300.0 + 20.0 * i, 6'399'900.0}, Angle::degrees(90.0)}, 100,
                                           100, 2.0, {0.1, 0.1}, random);
      json answer = json::parse(tracks->step(id, step, i, {}));
      answer.erase("track");
      answers.push_back(answer.dump());
      if (!restarts) continue;
      tracks.reset();
      tracks = registry({}, file);
    }
    return answers;
  };
  EXPECT_EQ(flight("undisturbed.sqlite", false), flight("restarted.sqlite", true));
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

TEST_F(TrackRegistryTest, HandsOutStepsAndTheEndToAStream) {
  TrackLimits limits;
  limits.streams = 1;
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  const std::string answer = tracks->step(id, step_of(0), 0, {});
  const auto stream = tracks->stream(id, -1);
  EXPECT_EQ(code_of([&] { tracks->stream(id, -1); }), "server-busy");
  EXPECT_EQ(stream->next()->steps.at(0).answer, answer);
  tracks->finish(id);
  EXPECT_EQ(stream->next()->ended, TrackEnd::kFinished);
  tracks->stop();
}

TEST_F(TrackRegistryTest, HandsOutStepsThatWereAnsweredBeforeTheEnd) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  const auto behind = tracks->stream(id, -1);
  const auto ahead = tracks->stream(id, -1);
  tracks->step(id, step_of(0), 0, {});
  EXPECT_EQ(ahead->next()->steps.size(), 1U);
  for (int i = 1; i < 100; ++i) tracks->step(id, step_of(i), i, {});
  tracks->finish(id);
  const auto rest_of = [](TrackRegistry::Listener& stream) {
    std::vector<std::int64_t> told;
    for (auto news = stream.next(); !news->ended; news = stream.next()) {
      for (const StoredStep& step : news->steps) told.push_back(step.sequence);
    }
    return told;
  };
  std::vector<std::int64_t> all(100);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(rest_of(*behind), all);
  all.erase(all.begin());
  EXPECT_EQ(rest_of(*ahead), all);
  EXPECT_EQ(ahead->next()->ended, TrackEnd::kFinished);
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
