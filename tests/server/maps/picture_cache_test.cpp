#include "server/maps/picture_cache.hpp"

#include <gtest/gtest.h>

namespace roadfix::server {
namespace {

TEST(PictureCache, ForgetsTheLeastRecentlyUsedAndStaysWithinItsBytes) {
  PictureCache cache(10'000);
  for (int i = 0; i < 20; ++i) {
    cache.insert("tile" + std::to_string(i), std::string(1000, 'x'));
    EXPECT_TRUE(cache.find("tile0")) << "used again and again";
    EXPECT_LE(cache.bytes(), 10'000U);
  }
  EXPECT_FALSE(cache.find("tile1"));
  EXPECT_TRUE(cache.find("tile19"));
}

TEST(PictureCache, KnowsTilesThatShowNothing) {
  PictureCache cache(10'000);
  EXPECT_EQ(cache.find("sea"), std::nullopt);
  cache.insert("sea", "");
  EXPECT_EQ(cache.find("sea"), "");
}

}  // namespace
}  // namespace roadfix::server
