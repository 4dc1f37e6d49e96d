// Which value of many rasters of roads stands for a certain road.
#include "tiles/imagery/share_range.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <vector>

namespace roadfix {
namespace {

/// Up to six of the values that ranges turn on.
std::vector<float> some_values(std::mt19937& random) {
  constexpr std::array<float, 8> kValues{0.0F, 1.0F, 2.0F, 3.0F, 200.0F, 255.0F, 256.0F, 60000.0F};
  std::vector<float> values(random() % 7);
  for (float& value : values) value = kValues[random() % kValues.size()];
  return values;
}

void append(const std::vector<float>& values, std::vector<float>& all) {
  all.insert(all.end(), values.begin(), values.end());
}

TEST(ShareRange, FollowsFromFourValuesOfEachImageAsFromAll) {
  std::mt19937 random(1);
  int ones = 0;
  for (int source = 0; source < 2000; ++source) {
    std::vector<float> all;
    std::vector<float> telling;
    for (int image = 0; image < 3; ++image) {
      const std::vector<float> values = some_values(random);
      append(values, all);
      append(telling_values(values), telling);
    }
    ASSERT_LE(telling.size(), std::size_t{12});
    ASSERT_EQ(share_range(telling, true).high, share_range(all, true).high);
    if (all.empty()) continue;
    ASSERT_EQ(std::ranges::min(telling), std::ranges::min(all));
    const float largest = std::ranges::max(all);
    ASSERT_EQ(are_ones_only(telling, largest), are_ones_only(all, largest));
    ones += are_ones_only(all, largest) ? 1 : 0;
  }
  EXPECT_GT(ones, 20) << "both answers were met";
}

}  // namespace
}  // namespace roadfix
