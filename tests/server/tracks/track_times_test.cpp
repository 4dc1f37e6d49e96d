#include "server/tracks/track_times.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace roadfix::server {
namespace {

using std::chrono::seconds;

StoredTrack touched(seconds ago) {
  StoredTrack track;
  track.id = "a";
  track.touched_us = now_us() - std::chrono::microseconds(ago).count();
  return track;
}

TEST(TrackTimes, KnowsHowOldEachOfTheLastStepsIs) {
  TrackTimes times;
  const auto take = [&](std::int64_t sequence, seconds ago) {
    times.took_step("a", sequence, TrackTimes::Clock::now() - ago);
  };
  const auto age_s = [&](std::int64_t sequence) {
    return std::chrono::duration<double>(times.age_of_step("a", sequence).value()).count();
  };
  times.begin("a");
  EXPECT_FALSE(times.age_of_step("a", 0));
  take(0, seconds(60));
  take(1, seconds(30));
  EXPECT_NEAR(age_s(0), 60.0, 9.0);
  EXPECT_NEAR(age_s(1), 30.0, 9.0);
  EXPECT_FALSE(times.age_of_step("a", 2));
  EXPECT_FALSE(times.age_of_step("b", 1));
  const auto last = static_cast<std::int64_t>(TrackTimes::kAged);
  for (std::int64_t i = 2; i <= last; ++i) take(i, seconds(0));
  EXPECT_FALSE(times.age_of_step("a", 0));
  EXPECT_TRUE(times.age_of_step("a", 1));
  EXPECT_TRUE(times.age_of_step("a", last));
  times.forget("a");
  EXPECT_FALSE(times.age_of_step("a", last));
}

TEST(TrackTimes, CountsTheSilenceOfATrackFromItsLastStepOrFromTheStartOfTheService) {
  constexpr std::chrono::milliseconds kWait(20);
  TrackTimes times;
  times.begin("a");
  std::this_thread::sleep_for(kWait);
  EXPECT_GE(times.idle("a"), kWait);
  EXPECT_GE(times.idle("of another run"), kWait);
  const auto before = TrackTimes::Clock::now();
  times.took_step("a", 0, before);
  EXPECT_LE(times.idle("a"), TrackTimes::Clock::now() - before);
}

TEST(TrackTimes, BelievesTheDateOnlyOfATrackThatWasNotHeardYet) {
  TrackTimes times;
  EXPECT_GE(times.silent(touched(seconds(100))), seconds(100));
  EXPECT_LT(times.silent(touched(seconds(-100))), seconds(50));  // the date was set back
  EXPECT_GE(times.silent(touched(seconds(-100))), seconds(0));
  EXPECT_LT(times.idle("a"), seconds(50));
  times.begin("a");
  EXPECT_LT(times.silent(touched(seconds(100))), seconds(50));
}

}  // namespace
}  // namespace roadfix::server
