#include "server/tracks/track_steps.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "tests/server/tracks/track_registry_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/eventually.hpp"

namespace roadfix::server {
namespace {

using roadfix::testing::code_of;

using TrackStepsTest = TrackRegistryTest;

TEST_F(TrackStepsTest, SaysOfAStepThatWasTakenMeanwhileThatItIsARepeatedOne) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  const auto came = TrackTimes::Clock::now() - std::chrono::seconds(60);
  const StepAnswer first = TrackSteps(*tracks).take(id, {step_of(0), 0, came}, {});
  const StepAnswer again = TrackSteps(*tracks).take(id, sent(step_of(0)), {});
  EXPECT_FALSE(first.repeated);
  EXPECT_TRUE(again.repeated);
  EXPECT_EQ(again.text, first.text);
  EXPECT_EQ(again.answer, nlohmann::json::parse(first.text));
  EXPECT_EQ(code_of([&] { TrackSteps(*tracks).take(id, sent(step_of(0), 1), {}); }), "step-differs");
  EXPECT_GE(tracks->times().age_of_step(id, 0), std::chrono::seconds(60));
  tracks->finish(id);
  EXPECT_FALSE(tracks->times().age_of_step(id, 0));
}

TEST_F(TrackStepsTest, LetsNoStepWaitThatWasTakenAlready) {
  TrackLimits limits;
  limits.order_wait = std::chrono::seconds(10);
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  take(*tracks, id, 0);
  take(*tracks, id, 1);
  const auto before = TrackTimes::Clock::now();
  take(*tracks, id, 0);
  EXPECT_LT(TrackTimes::Clock::now() - before, limits.order_wait);
}

TEST_F(TrackStepsTest, NamesTheMapTheProgramAndTheDetectorInWhatItKeeps) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  TrackSteps(*tracks).take(id, sent(step_of(0)), {});
  const auto kept = nlohmann::json::parse(tracks->last_step(id).value().answer);
  EXPECT_EQ(kept["map"], (nlohmann::json{{"name", "town"}, {"version", maps_.find("town")->view.id.version}}));
  EXPECT_TRUE(kept["made_by"].contains("roadfix"));
  EXPECT_FALSE(kept["made_by"].contains("detector"));
  TrackSteps(*tracks).take(id, {step_of(1), 1, TrackTimes::Clock::now(), "tree"}, {});
  EXPECT_EQ(nlohmann::json::parse(tracks->last_step(id).value().answer)["made_by"]["detector"], "tree");
}

TEST_F(TrackStepsTest, RefusesWhatCannotFollowBeforeItsRoadsAreLookedFor) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  TrackSteps steps(*tracks);
  EXPECT_FALSE(steps.answered(id, sent(step_of(2)))) << "the first one";
  const StepAnswer taken = steps.take(id, sent(step_of(2)), {});
  EXPECT_EQ(steps.answered(id, sent(step_of(2))).value().text, taken.text);
  const auto refusal = [&](const StepInput& step) { return code_of([&] { steps.answered(id, sent(step)); }); };
  EXPECT_EQ(refusal(step_of(3)), "no error");
  EXPECT_EQ(refusal(step_of(1)), "step-late");
  StepInput step = step_of(3);
  step.time_us = step_of(2).time_us;
  EXPECT_EQ(refusal(step), "time-backwards");
  step.time_us += 1000;
  EXPECT_EQ(refusal(step), "impossible-speed");
}

TEST_F(TrackStepsTest, ShowsParticlesWhileAStepIsUnderWay) {
  const auto map = maps_.find("town");
  LiveTrack track(map, {});
  std::optional<LiveTrack::Turn> step(std::in_place, track, 0, std::chrono::milliseconds(0));
  step->settle(track.tracker().advance(step->state(), step_of(0)).state);
  auto shown = std::async(std::launch::async, [&] { return track.particles(100).size(); });
  EXPECT_EQ(shown.wait_for(std::chrono::seconds(10)), std::future_status::ready);
  step.reset();
  EXPECT_EQ(shown.get(), 100U);
}

TEST_F(TrackStepsTest, TakesStepsOfSeveralThreadsInOrder) {
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

TEST_F(TrackStepsTest, LetsNoMoreStepsWaitForThoseBeforeThemThanItMay) {
  TrackLimits limits;
  limits.order_wait = std::chrono::minutes(10);
  limits.steps_waiting = 2;
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  take(*tracks, id, 0);
  TrackSteps steps(*tracks);
  std::vector<std::jthread> early;
  const auto is_refused = [&](std::int64_t sequence) {
    return code_of([&] { steps.await_predecessor(id, sequence); }) == "server-busy";
  };
  const auto waits = [&] { EXPECT_TRUE(testing::eventually([&] { return !is_refused(2); })); };
  for (int i = 0; i < 2; ++i) early.emplace_back(waits);  // which the look below may keep from it at first
  const auto is_busy = [&] { return is_refused(1); };
  EXPECT_TRUE(testing::eventually(is_busy));
  take(*tracks, id, 1);
  early.clear();
  EXPECT_FALSE(is_busy());
}

}  // namespace
}  // namespace roadfix::server
