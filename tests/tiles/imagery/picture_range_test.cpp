// Which values of many pictures become black and white.
#include "tiles/imagery/picture_range.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace roadfix {
namespace {

constexpr std::size_t kMost = 1000;

/// From `first` on, each larger by one.
std::vector<float> ramp(int first, int count) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.push_back(static_cast<float>(first + i));
  return values;
}

TEST(ThinnedValues, AreAllThereWhileTheyAreFew) {
  ThinnedValues values(kMost);
  values.add(ramp(0, 600));
  values.add({});
  values.add(ramp(600, 399));
  EXPECT_EQ(std::move(values).take(), ramp(0, 999));
}

TEST(ThinnedValues, OfAnyNumberOfImagesAreFewAndGiveTheSameRange) {
  ThinnedValues values(kMost);
  constexpr int kImages = 500;
  constexpr int kOfEach = 77;
  for (int image = 0; image < kImages; ++image) values.add(ramp(image * kOfEach, kOfEach));
  const std::vector<float> kept = std::move(values).take();
  EXPECT_LT(kept.size(), kMost);
  EXPECT_GE(kept.size(), kMost / 2);
  const ValueRange of_all = percentile_range(ramp(0, kImages * kOfEach));
  const ValueRange range = percentile_range(kept);
  EXPECT_NEAR(range.low, of_all.low, 0.003 * kImages * kOfEach);
  EXPECT_NEAR(range.high, of_all.high, 0.003 * kImages * kOfEach);
}

}  // namespace
}  // namespace roadfix
