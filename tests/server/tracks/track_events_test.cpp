#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "tests/server/tracks/track_registry_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::server {
namespace {

using roadfix::testing::code_of;

using TrackEvents = TrackRegistryTest;

TEST_F(TrackEvents, HandsOutStepsAndTheEndToAStream) {
  TrackLimits limits;
  limits.streams = 1;
  const auto tracks = registry(limits);
  const std::string id = begin(*tracks);
  const std::string answer = tracks->step(id, step_of(0), 0, {}).text;
  const auto stream = tracks->stream(id, -1);
  EXPECT_EQ(code_of([&] { tracks->stream(id, -1); }), "server-busy");
  EXPECT_EQ(stream->next()->steps.at(0).answer, answer);
  tracks->finish(id);
  EXPECT_EQ(stream->next()->ended, TrackEnd::kFinished);
  tracks->stop();
}

TEST_F(TrackEvents, HandsOutStepsThatWereAnsweredBeforeTheEnd) {
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

}  // namespace
}  // namespace roadfix::server
