#include "server/http/url.hpp"

#include <gmock/gmock.h>

#include "core/units/error.hpp"

namespace roadfix::http {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Url, DecodesSegmentsOneByOneSoThatAnEncodedSlashStaysInside) {
  EXPECT_THAT(parse_target("/v1/maps/a%2Fb/window").segments, ElementsAre("v1", "maps", "a/b", "window"));
}

TEST(Url, ReadsTheQueryInOrderWithEmptyAndRepeatedValues) {
  EXPECT_THAT(parse_target("/x?lat=57.7&name=a+b%26c&flag&lat=1#part").query,
              ElementsAre(Pair("lat", "57.7"), Pair("name", "a b&c"), Pair("flag", ""), Pair("lat", "1")));
}

TEST(Url, SaysAtWhichByteThePercentEncodingIsBroken) {
  for (const char* target : {"/a%", "/a%2", "/a%zz", "/a?x=%g1"}) {
    try {
      parse_target(target);
      FAIL() << target;
    } catch (const InvalidInput& error) {
      EXPECT_EQ(error.code(), "bad-url");
      EXPECT_THAT(error.what(), ::testing::HasSubstr("byte "));
    }
  }
}

TEST(Url, RefusesPathsWithNulAndWithoutRoot) {
  EXPECT_THROW(parse_target("/a%00b"), InvalidInput);
  EXPECT_THROW(parse_target("maps"), InvalidInput);
  EXPECT_THROW(parse_target(""), InvalidInput);
}

}  // namespace
}  // namespace roadfix::http
