#include "server/tracks/track_events.hpp"

#include <gtest/gtest.h>

#include <future>
#include <numeric>

#include "tests/server/tracks/track_registry_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::server {
namespace {

using roadfix::testing::code_of;

/// Of one track, whose steps are gone as soon as it has ended.
class TrackEventsTest : public ::testing::Test {
 protected:
  void take(std::int64_t sequence) {
    steps_.push_back({sequence, 0, "{}"});
    events_.announce();
  }
  std::vector<StoredStep> steps_after(std::int64_t after) const {
    std::vector<StoredStep> steps = steps_;
    std::erase_if(steps, [&](const StoredStep& step) { return step.sequence <= after; });
    return steps;
  }
  void end(TrackEnd how) {
    events_.end("a", [&](const auto& after) {
      auto left = after ? steps_after(*after) : std::vector<StoredStep>();
      ended_ = how;
      steps_.clear();
      return left;
    });
  }
  TrackEvents::News stored(std::int64_t after, int count) const {
    std::vector<StoredStep> steps = steps_after(after);
    steps.resize(std::min(steps.size(), static_cast<std::size_t>(count)));
    return {std::move(steps), ended_};
  }

  std::vector<StoredStep> steps_;
  std::optional<TrackEnd> ended_;
  TrackEvents events_{2, [this](const auto&, auto after, int count) { return stored(after, count); }};
};

TEST_F(TrackEventsTest, HandsOutStepsThatWereAnsweredBeforeTheEnd) {
  const auto behind = events_.stream("a", -1);
  const auto ahead = events_.stream("a", -1);
  take(0);
  EXPECT_EQ(ahead->next()->steps.size(), 1U);
  for (int i = 1; i < 100; ++i) take(i);
  end(TrackEnd::kFinished);
  end(TrackEnd::kExpired);  // by another thread at the same time
  const auto rest_of = [](TrackEvents::Subscription& stream) {
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
  EXPECT_TRUE(ahead->next()->ended);
}

TEST_F(TrackEventsTest, GoesOnAfterTheStepThatAClientHeardLast) {
  for (int i = 0; i < 3; ++i) take(i);
  const auto stream = events_.stream("a", 1);
  const auto news = stream->next();
  ASSERT_EQ(news->steps.size(), 1U);
  EXPECT_EQ(news->steps.front().sequence, 2);
}

TEST_F(TrackEventsTest, HasNoMoreStreamsThanItMay) {
  const auto first = events_.stream("a", -1);
  auto second = events_.stream("b", -1);
  EXPECT_EQ(code_of([&] { events_.stream("a", -1); }), "server-busy");
  second.reset();
  EXPECT_EQ(events_.streams(), 1);
  EXPECT_EQ(code_of([&] { events_.stream("a", -1); }), "no error");
}

TEST_F(TrackEventsTest, EndsAStreamThatWaitsWhenTheServiceStops) {
  const auto stream = events_.stream("a", -1);
  auto told = std::async(std::launch::async, [&] {
    auto news = stream->next();
    while (news) news = stream->next();
  });
  events_.stop();
  EXPECT_EQ(told.wait_for(std::chrono::seconds(60)), std::future_status::ready);
}

TEST_F(TrackRegistryTest, HandsOutStepsAndTheEndToAStream) {
  TrackLimits limits;
  limits.streams = 1;
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  const std::string answer = TrackSteps(*tracks).take(id, sent(step_of(0)), {}).text;
  const auto stream = tracks->stream(id, -1);
  EXPECT_EQ(code_of([&] { tracks->stream(id, -1); }), "server-busy");
  EXPECT_EQ(stream->next()->steps.at(0).answer, answer);
  TrackSteps(*tracks).take(id, sent(step_of(1)), {});
  tracks->finish(id);
  EXPECT_EQ(stream->next()->steps.at(0).sequence, 1);
  EXPECT_EQ(stream->next()->ended, TrackEnd::kFinished);
  tracks->stop();
}

TEST_F(TrackRegistryTest, HandsOutNoStepsOfAnotherTrackThatEnds) {
  const auto tracks = registry();
  const std::string id = begin(*tracks);
  const auto stream = tracks->stream(id, -1);
  const auto other = tracks->stream(begin(*tracks), -1);
  TrackSteps(*tracks).take(id, sent(step_of(0)), {});
  tracks->finish(id);
  EXPECT_EQ(stream->next()->steps.size(), 1U);
  const auto news = other->next();
  EXPECT_TRUE(news->steps.empty());
  EXPECT_FALSE(news->ended);
  tracks->stop();
}

}  // namespace
}  // namespace roadfix::server
