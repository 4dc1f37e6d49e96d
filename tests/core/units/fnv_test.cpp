#include "core/units/fnv.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(Fnv1a64, GivesThePublishedValues) {
  // Test vectors of draft-eastlake-fnv.
  EXPECT_EQ(fnv1a64(""), "cbf29ce484222325");
  EXPECT_EQ(fnv1a64("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(fnv1a64("foobar"), "85944171f73967e8");
}

TEST(Fnv1a64, IsThatOfThePartsOneAfterTheOther) {
  Fnv1a64 hash;
  hash.add("foo");
  hash.add("bar");
  EXPECT_EQ(hash.text(), fnv1a64("foobar"));
  EXPECT_EQ(hash.value(), 0x85944171f73967e8ULL);
}

}  // namespace
}  // namespace roadfix
