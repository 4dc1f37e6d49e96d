// Tracks in their store: after a restart, where it is full, damaged or missing.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/server/tracks/track_registry_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/sqlite_file.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;
using roadfix::testing::code_of;

using KeptTracks = TrackRegistryTest;

TEST_F(KeptTracks, GoesOnAfterARestartAsWithoutOne) {
  const std::vector<std::string> expected = undisturbed(6);
  std::string id;
  for (int i = 0; i < 6; ++i) {
    const auto tracks = registry();
    if (i == 0) id = begin(*tracks);
    EXPECT_EQ(take(*tracks, id, i), expected[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(registry()->steps_after(id, -1, 100).size(), 6U);
}

TEST_F(KeptTracks, SaysAfterARestartHowLongATrackHasBeenSilentWithoutEndingIt) {
  TrackLimits limits;
  limits.idle = std::chrono::seconds(60);
  const std::string id = begin(*registry());
  take(*registry(), id, 0);
  testing::open_sqlite(folder_ / "tracks.sqlite").execute("UPDATE tracks SET touched_us = touched_us - 100000000");
  const auto tracks = registry(limits);
  EXPECT_GE(tracks->times().silent(tracks->find(id)), std::chrono::seconds(100));
  EXPECT_LT(tracks->times().idle(id), limits.idle);
  take(*tracks, id, 1);
  EXPECT_LT(tracks->times().silent(tracks->find(id)), limits.idle);
}

TEST_F(KeptTracks, IsAsItWasAfterAStepThatTheFullStoreRefused) {
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

TEST_F(KeptTracks, SaysThatTheStoredStateIsDamaged) {
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
  for (const char* state : {"zeroblob(200)", "substr(state, 1, 1000)", "'{}'"}) {
    EXPECT_EQ(damaged_by((std::string("UPDATE tracks SET state = ") + state).c_str()), "track-store-corrupt") << state;
  }
  EXPECT_EQ(damaged_by("UPDATE tracks SET request = 'nothing'"), "track-store-corrupt");
}

TEST_F(KeptTracks, KeepsTracksAsSoonAsTheStoreCanBeOpened) {
  const auto tracks = registry({}, "later/tracks.sqlite");
  EXPECT_TRUE(tracks->problem());
  EXPECT_EQ(code_of([&] { begin(*tracks); }), "track-store-unavailable");
  std::filesystem::create_directory(folder_ / "later");
  EXPECT_FALSE(tracks->problem());
  EXPECT_EQ(code_of([&] { begin(*tracks); }), "no error");
}

TEST_F(KeptTracks, SearchesOverTheSameFramesAfterARestart) {
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
      json answer = TrackSteps(*tracks).take(id, sent(step, i), {}).answer;
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

TEST_F(KeptTracks, DoesNotKnowHowOldAStepFromBeforeARestartIs) {
  const std::string id = begin(*registry());
  take(*registry(), id, 0);
  const auto tracks = registry();
  EXPECT_FALSE(tracks->times().age_of_step(id, 0));
  take(*tracks, id, 1);
  EXPECT_FALSE(tracks->times().age_of_step(id, 0));
  EXPECT_TRUE(tracks->times().age_of_step(id, 1));
}

}  // namespace
}  // namespace roadfix::server
