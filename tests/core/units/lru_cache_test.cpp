#include "core/units/lru_cache.hpp"

#include <gtest/gtest.h>

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

TEST(LruCache, DoesNotKeepWhatIsLargerThanAllOfIt) {
  Cache cache(10);
  cache.insert(1, "small", 5);
  cache.insert(2, "large", 11);
  EXPECT_EQ(cache.find(2), std::nullopt);
  EXPECT_EQ(cache.bytes(), 0U) << "it made room for it first";
}

}  // namespace
}  // namespace roadfix
