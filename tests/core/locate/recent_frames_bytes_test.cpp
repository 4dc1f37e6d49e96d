#include "core/locate/recent_frames_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::code_of;

TEST(RecentFramesBytes, ComeBackFromTheirBytesAndRefuseDamagedOnes) {
  EXPECT_TRUE(to_bytes(RecentFrames()).empty());
  EXPECT_TRUE(recent_frames_of({}) == RecentFrames());
  RecentFrames recent;
  for (int i = 0; i < 3; ++i) {
    recent.keep(FeatureMap::centred(CellArray(20 + i, 20 + i, kNoRoad), 2.0));
    recent.move({15.0, 1.0, Angle::degrees(4.0)}, {{{1.0, 0, 0}, {0, 1.0, 0}, {0, 0, 1e-4}}});
  }
  const std::vector<std::byte> whole = to_bytes(recent);
  EXPECT_TRUE(recent_frames_of(whole) == recent);
  const auto refusal = [](std::span<const std::byte> bytes) { return code_of([&] { recent_frames_of(bytes); }); };
  for (std::size_t size = 1; size < whole.size(); size += 7) {
    EXPECT_EQ(refusal(std::span(whole).first(size)), "track-frames-corrupt") << size;
  }
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_EQ(refusal(longer), "track-frames-corrupt");
  for (std::size_t word = 0; word < 12; ++word) {
    std::vector<std::byte> damaged = whole;
    std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(8 * word), 8, std::byte{0xff});
    EXPECT_EQ(refusal(damaged), "track-frames-corrupt") << word;
  }
}

}  // namespace
}  // namespace roadfix
