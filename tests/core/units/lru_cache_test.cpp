#include "core/units/lru_cache.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <string>

namespace roadfix {
namespace {

using Cache = LruCache<int, std::string>;

TEST(LruCache, ForgetsTheLeastRecentlyUsedAndStaysWithinItsBytes) {
  Cache cache(10);
  for (int key = 0; key < 20; ++key) {
    cache.insert(key, std::to_string(key), 2);
    EXPECT_EQ(cache.find(0), "0") << "used again and again";
    EXPECT_LE(cache.bytes(), 10U);
  }
  EXPECT_EQ(cache.find(15), std::nullopt);
  EXPECT_EQ(cache.find(16), "16");
  EXPECT_EQ(cache.bytes(), 10U);
}

TEST(LruCache, KeepsTheFirstValueOfAKeyAndCountsItOnce) {
  Cache cache(10);
  cache.insert(1, "first", 5);
  cache.insert(1, "second", 5);
  EXPECT_EQ(cache.find(1), "first");
  EXPECT_EQ(cache.bytes(), 5U);
}

TEST(LruCache, LeavesWhatIsLargerThanAllOfItOutAndKeepsTheOthers) {
  Cache cache(10);
  cache.insert(1, "small", 5);
  cache.insert(2, "large", 11);
  EXPECT_EQ(cache.find(2), std::nullopt);
  EXPECT_EQ(cache.find(1), "small");
  EXPECT_EQ(cache.bytes(), 5U);
}

/// Memory that runs out where a key finds its place.
struct FailingHash {
  static inline int calls_left = 0;
  std::size_t operator()(int key) const {
    if (calls_left-- == 0) throw std::bad_alloc();
    return std::hash<int>()(key);
  }
};

TEST(LruCache, IsAsItWasWhereAValueFindsNoRoom) {
  LruCache<int, std::string, FailingHash> cache(100);
  FailingHash::calls_left = 1000;
  cache.insert(1, "one", 60);
  FailingHash::calls_left = 1;  // it is looked for, and then put in place
  EXPECT_THROW(cache.insert(2, "two", 60), std::bad_alloc);
  FailingHash::calls_left = 1000;
  EXPECT_EQ(cache.bytes(), 60U);
  cache.insert(3, "three", 40);
  cache.insert(4, "four", 50);
  EXPECT_EQ(cache.find(1), std::nullopt);
  cache.insert(5, "five", 50);
  EXPECT_EQ(cache.find(3), std::nullopt);
  EXPECT_EQ(cache.bytes(), 100U);
}

}  // namespace
}  // namespace roadfix
