#include "core/filter/ranges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace roadfix {
namespace {

TEST(Ranges, CoverEverythingOnceHoweverManyThreadsThereAre) {
  for (const int threads : {1, 2, 3, 7}) {
    for (const std::size_t count : {0U, 1U, 1023U, 5000U}) {
      std::vector<int> times(count);
      for_ranges(count, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) ++times[i];
      });
      EXPECT_EQ(std::ranges::count(times, 1), static_cast<std::ptrdiff_t>(count)) << threads;
    }
  }
}

TEST(Ranges, PassOnWhatTheWorkOfAnotherThreadThrows) {
  const auto work = [](std::size_t first, std::size_t) {
    if (first > 0) throw std::runtime_error("no memory");
  };
  EXPECT_THROW(for_ranges(5000, 2, work), std::runtime_error);
}

}  // namespace
}  // namespace roadfix
