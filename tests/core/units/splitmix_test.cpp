#include "core/units/splitmix.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(SplitMix64, GivesThePublishedValues) {
  // Of java.util.SplittableRandom and Vigna's splitmix64.c, seed 1234567.
  SplitMix64 random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317ULL);
  EXPECT_EQ(random.next(), 3203168211198807973ULL);
  EXPECT_EQ(random.next(), 9817491932198370423ULL);
  EXPECT_EQ(random.next(), 4593380528125082431ULL);
  EXPECT_EQ(random.next(), 16408922859458223821ULL);
}

TEST(SplitMix64, DrawsSharesOfOneFromTheUpperBits) {
  SplitMix64 random(1234567);
  EXPECT_EQ(random.uniform(), static_cast<double>(6457827717110365317ULL >> 11U) / 9007199254740992.0);
}

}  // namespace
}  // namespace roadfix
