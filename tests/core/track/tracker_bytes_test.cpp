#include "core/track/tracker_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/support/sketches.hpp"

namespace roadfix {
namespace {

using testing::code_of;

constexpr std::size_t kWordBytes = 8;

TrackerState flown() {
  TrackerState state;
  state.filter.particles = {{600'700.25, 600'699.5},
                            {6'399'400.1, 6'399'399.9},
                            {-3.1, 1.0 / 3.0},
                            {-0.0, 0.25},
                            {1e-300, -4.0},
                            {0.02, -0.01},
                            {0.75, 0.25}};
  state.filter.seed = 0xfedcba9876543210U;
  state.filter.step = 80;
  state.filter.resets = 2;
  state.filter.slow_fit = 0.625;
  state.filter.fast_fit = 0.0;
  state.searched = true;
  state.last = StepStamp{41, 42'000'000};
  state.measured = 40;
  state.last_search = 11;
  state.nadir_sigma_m = 5.25;
  state.claim = {4, 7.5, true, 40'000'000, 12.5};
  state.accepted_time_us = 41'000'000;
  for (int i = 0; i < 3; ++i) {
    state.recent.keep(FeatureMap::centred(CellArray(20 + i, 21, kNoRoad), 2.0));
    state.recent.move({15.0, 1.0, Angle::degrees(4.0)}, {{{1.0, 0, 0}, {0, 1.0, 0}, {0, 0, 1e-4}}});
  }
  state.last_view = {{{0x123456789abcdef0U, 12.5, 0.25}, {0xfedcba9876543210U, 20.5, 0.5}}, true, {}, {}};
  FeatureMap earlier = FeatureMap::centred(CellArray(3, 2, kRoad), 4.0);
  earlier.nadir_sigma_m = 5.25;
  earlier.nadir_heading_sigma = Angle::radians(0.01);
  state.last_view.earlier.keep(earlier);
  state.last_view.earlier_picture = {testing::random_sketch(3), {12.5, -0.5, Angle::degrees(3.0)}, true};
  state.motion = {BodyVelocity{14.5, -0.25}, 0.1, true, true, 2.5, 45.0, 3.5};
  state.reach = Reach{{600'700.5, 6'399'400.25}, Angle::degrees(60.0), 31.5, Angle::degrees(6.0), 0.01};
  return state;
}

/// That has seen nothing yet.
TrackerState blind() {
  TrackerState state = flown();
  state.measured = state.last_search = 0;
  state.searched = false;
  state.nadir_sigma_m = 0.0;
  state.claim = {};
  state.accepted_time_us.reset();
  state.recent.clear();
  state.last_view = {};
  state.motion = {};
  state.reach.reset();
  return state;
}

std::string refusal_of(std::span<const std::byte> bytes) {
  return code_of([&] { tracker_state_of(bytes); });
}

std::vector<std::byte> with_word(std::vector<std::byte> bytes, std::size_t index, std::uint64_t word) {
  const auto replaced = std::bit_cast<std::array<std::byte, kWordBytes>>(word);
  std::ranges::copy(replaced, bytes.begin() + static_cast<std::ptrdiff_t>(kWordBytes * index));
  return bytes;
}

TEST(TrackerBytes, BringAStateBackToTheLastBit) {
  for (const TrackerState& state : {flown(), blind()}) {
    const TrackerState back = tracker_state_of(to_bytes(state));
    EXPECT_TRUE(back == state);
    EXPECT_TRUE(std::signbit(back.filter.particles.drift_east_m_s[0])) << "which == does not tell";
    EXPECT_EQ(to_bytes(back), to_bytes(state));
  }
}

TEST(TrackerBytes, ThatTheFuzzTargetBeginsWithAreOfThisFormat) {
  for (const char* name : {"state", "state_blind"}) {
    std::ifstream in(std::filesystem::path(ROADFIX_TRACK_CORPUS) / name, std::ios::binary);
    const std::string input{std::istreambuf_iterator<char>(in), {}};
    ASSERT_GT(input.size(), 1U) << name;
    EXPECT_EQ(refusal_of(std::as_bytes(std::span(input)).subspan(1)), "no error") << name;
  }
}

TEST(TrackerBytes, AreRefusedWhereTheyAreCutOrGoOn) {
  std::vector<std::byte> bytes = to_bytes(flown());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(refusal_of(std::span(bytes).first(size)), "track-store-corrupt") << size;
  }
  bytes.push_back(std::byte{0});
  EXPECT_EQ(refusal_of(bytes), "track-store-corrupt");
}

TEST(TrackerBytes, AreRefusedWhereAWordIsDamagedThatMayNotBeAnything) {
  const std::vector<std::byte> bytes = to_bytes(blind());
  ASSERT_EQ(bytes.size() % kWordBytes, 0U);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < bytes.size() / kWordBytes; ++i) {
    // -1 among whole numbers, and no number among the others
    const auto damaged = with_word(bytes, i, ~std::uint64_t{0});
    if (refusal_of(damaged) == "track-store-corrupt") continue;
    EXPECT_EQ(to_bytes(tracker_state_of(damaged)), damaged) << i;
    ++taken;
  }
  EXPECT_EQ(taken, 3U) << "seed, step and resets of the filter";
}

TEST(TrackerBytes, WithCountsBeyondTheirEndAreRefusedBeforeAnyMemoryIsReserved) {
  const std::vector<std::byte> bytes = to_bytes(blind());
  const std::size_t words = bytes.size() / kWordBytes;
  const std::size_t columns = 7;
  const std::size_t particles = words - 1 - 2 * columns - 1;  // before the columns of both and the count of frames
  EXPECT_EQ(refusal_of(with_word(bytes, particles, 2)), "no error");
  EXPECT_EQ(refusal_of(with_word(bytes, particles, 0)), "track-store-corrupt") << "a filter without particles";
  for (const std::uint64_t count : {1ULL, 3ULL, 1ULL << 40U, (1ULL << 61U) + 2, ~0ULL}) {
    EXPECT_EQ(refusal_of(with_word(bytes, words - 1, count)), "track-store-corrupt") << count;
    EXPECT_EQ(refusal_of(with_word(bytes, particles, count)), "track-store-corrupt") << count;
  }
}

TEST(TrackerBytes, OfAnotherFormatAreRefused) {
  const std::vector<std::byte> bytes = to_bytes(flown());
  EXPECT_EQ(refusal_of(with_word(bytes, 0, 0x3130'5354'4652ULL)), "track-store-corrupt");
}

/// With cells of these sizes, taken so far ahead.
RecentFrames frames_of(const std::vector<double>& sizes_m, double forward_m = 0.0) {
  std::vector<RecentFrames::Frame> frames(sizes_m.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].placed = {FeatureMap::centred(CellArray(2, 2), sizes_m[i]), {forward_m, 0.0, {}}};
  }
  return RecentFrames(std::move(frames));
}

TEST(TrackerBytes, WithValuesThatNoTrackHasAreRefused) {
  const std::vector<std::function<void(TrackerState&)>> damages{
      [](TrackerState& s) {
        s.filter.particles.weight = {0.0, 0.0};
      },
      [](TrackerState& s) {
        s.filter.particles.weight = {1.5, -0.5};
      },
      [](TrackerState& s) { s.filter.particles.log_scale[1] = 1.5; },
      [](TrackerState& s) { s.filter.slow_fit = 0.0; },
      [](TrackerState& s) { s.filter.fast_fit = 1.5; },
      [](TrackerState& s) { s.last->sequence = -1; },
      [](TrackerState& s) { s.measured = std::numeric_limits<std::int64_t>::max(); },
      [](TrackerState& s) { s.last_search = s.measured + 1; },
      [](TrackerState& s) { s.nadir_sigma_m = -1.0; },
      [](TrackerState& s) { s.motion.unseen_m = -1.0; },
      [](TrackerState& s) { s.motion.unseen_s = -1.0; },
      [](TrackerState& s) { s.claim.supported = TrackClaim::kMaxSupport + 1; },
      [](TrackerState& s) { s.claim.log_odds = -0.5; },
      [](TrackerState& s) { s.last_view.seen[1].moved_m = -1.0; },
      [](TrackerState& s) { s.last_view.earlier = s.recent; },
      [](TrackerState& s) { s.last_view.earlier_picture->sketch.parts[7] = 2; },
      [](TrackerState& s) { s.recent = frames_of({0.0}); },
      [](TrackerState& s) {
        s.recent = frames_of({1.0, 2.0});
      },
      [](TrackerState& s) { s.recent = frames_of({1.0}, 99.0); }};
  for (std::size_t i = 0; i < damages.size(); ++i) {
    TrackerState state = flown();
    damages[i](state);
    EXPECT_EQ(refusal_of(to_bytes(state)), "track-store-corrupt") << i;
  }
}

}  // namespace
}  // namespace roadfix
