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

TEST(Url, FindsThePathInAWholeUrl) {
  const Target target = parse_target("HTTP://maps.example:8080/v1/a%2Fb?lat=1");
  EXPECT_EQ(target.authority, "maps.example:8080");
  EXPECT_EQ(target.path, "/v1/a%2Fb");
  EXPECT_THAT(target.segments, ElementsAre("v1", "a/b"));
  EXPECT_THAT(target.query, ElementsAre(Pair("lat", "1")));
  EXPECT_EQ(parse_target("http://x").path, "/");
  EXPECT_THAT(parse_target("http://x?lat=1").query, ElementsAre(Pair("lat", "1")));
  EXPECT_EQ(parse_target("/a").authority, "");
  EXPECT_THROW(parse_target("ftp://x/a"), InvalidInput);
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
  EXPECT_THAT([] { parse_target("http://x/a%zz"); },
              ::testing::ThrowsMessage<InvalidInput>(::testing::HasSubstr("byte 10 ")));
}

TEST(Url, RefusesPathsWithNulAndWithoutRoot) {
  EXPECT_THROW(parse_target("/a%00b"), InvalidInput);
  EXPECT_THROW(parse_target("maps"), InvalidInput);
  EXPECT_THROW(parse_target(""), InvalidInput);
}

}  // namespace
}  // namespace roadfix::http
