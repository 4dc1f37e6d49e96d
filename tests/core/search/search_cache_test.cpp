#include "core/search/search_cache.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <latch>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <vector>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

struct Kept {
  int value = 0;
  std::size_t size = 10;
  std::size_t bytes() const { return size; }
};

GridGeometry window(int col) { return {2.0, {col, 0}, 10, 10}; }

TEST(SearchCache, BuildsOnceForEachWindowAndParameters) {
  SearchCache cache(1000);
  int built = 0;
  const auto get = [&](int col, const SearchCache::Parameters& parameters) {
    return cache.get<Kept>(window(col), parameters, {}, [&] { return Kept{++built}; })->value;
  };
  EXPECT_EQ(get(1, {5, 4}), 1);
  EXPECT_EQ(get(1, {5, 4}), 1);
  EXPECT_EQ(get(2, {5, 4}), 2);
  EXPECT_EQ(get(1, {5, 3}), 3);
  EXPECT_EQ(get(1, {5, 4, 2}), 4);
  EXPECT_EQ(get(1, {5, 4}), 1);
  EXPECT_EQ(cache.bytes(), 40U);
}

TEST(SearchCache, StaysWithinItsBytesAndGivesUpWhatWasNotAskedForTheLongest) {
  SearchCache cache(25);
  int built = 0;
  const auto get = [&](int col) { return cache.get<Kept>(window(col), {}, {}, [&] { return Kept{++built}; }); };
  get(1);
  get(2);
  get(1);
  get(3);  // 2 goes
  EXPECT_EQ(cache.bytes(), 20U);
  EXPECT_EQ(get(1)->value, 1);
  EXPECT_EQ(get(2)->value, 4);
  const auto large = cache.get<Kept>(window(9), {}, {}, [] { return Kept{7, 100}; });
  EXPECT_EQ(large->value, 7) << "what does not fit is used all the same";
  EXPECT_LE(cache.bytes(), 25U);
}

TEST(SearchCache, GivesUpTheOldestAsFastHoweverMuchIsKept) {
  constexpr int kMany = 20'000;
  SearchCache cache(std::size_t{10} * kMany);
  const auto time_of = [&](int first) {
    const std::clock_t begin = std::clock();
    for (int col = first; col < first + kMany; ++col) cache.get<Kept>(window(col), {}, {}, [] { return Kept{}; });
    return static_cast<double>(std::clock() - begin);
  };
  const double filling = time_of(0);
  const double replacing = time_of(kMany);
  EXPECT_EQ(cache.bytes(), 10U * kMany);
  EXPECT_LT(replacing, 20.0 * filling);  // some hundred times it if all that is kept is looked through
}

TEST(SearchCache, WhatFailedIsBuiltAnew) {
  SearchCache cache(100);
  const auto fails = []() -> Kept { throw std::runtime_error("no"); };
  EXPECT_THROW(cache.get<Kept>(window(1), {}, {}, fails), std::runtime_error);
  EXPECT_EQ(cache.get<Kept>(window(1), {}, {}, [] { return Kept{8}; })->value, 8);
}

TEST(SearchCache, ManyThreadsThatWantTheSameBuildItOnce) {
  SearchCache cache(1000);
  std::atomic<int> built{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&] {
        for (int k = 0; k < 50; ++k) {
          const auto piece = cache.get<Kept>(window(k), {}, {}, [&] { return Kept{++built > 0 ? 2 * k : 0}; });
          EXPECT_EQ(piece->value, k * 2);
        }
      });
    }
  }
  EXPECT_EQ(built, 50);
  EXPECT_EQ(cache.bytes(), 500U);
}

TEST(SearchCache, WaitsForWhatAnotherBuildsNoLongerThanTheDeadline) {
  SearchCache cache(1000);
  std::latch begun(1);
  std::latch may_end(1);
  std::jthread other([&] {
    cache.get<Kept>(window(1), {}, {}, [&] {
      begun.count_down();
      may_end.wait();
      return Kept{5};
    });
  });
  begun.wait();
  const Deadline soon({}, std::chrono::steady_clock::now() + std::chrono::milliseconds(30));
  EXPECT_EQ(cache.get<Kept>(window(1), {}, soon, [] { return Kept{6}; }), nullptr);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(cache.get<Kept>(window(1), {}, Deadline(stop.get_token()), [] { return Kept{6}; }), Interrupted);
  may_end.count_down();
  EXPECT_EQ(cache.get<Kept>(window(1), {}, {}, [] { return Kept{6}; })->value, 5);
}

}  // namespace
}  // namespace roadfix
