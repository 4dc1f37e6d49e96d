#include "core/units/parallel_for.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace roadfix {
namespace {

using ::testing::Each;

TEST(ParallelFor, WorksEachIndexOnceWithAnyNumberOfThreads) {
  for (const int threads : {0, 1, 3, 100}) {
    std::vector<std::atomic<int>> calls(50);
    parallel_for(50, threads, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
    EXPECT_THAT(std::vector<int>(calls.begin(), calls.end()), Each(1)) << threads;
  }
}

TEST(ParallelFor, OfNothingDoesNothing) {
  parallel_for(0, 4, [](int) { FAIL(); });
}

TEST(ParallelFor, ThrowsWhatTheWorkThrowsAndBeginsNothingMore) {
  int calls = 0;
  const auto fails_at_third = [&](int i) {
    ++calls;
    if (i == 2) throw std::runtime_error("third");
  };
  EXPECT_THROW(parallel_for(1000, 1, fails_at_third), std::runtime_error);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace roadfix
