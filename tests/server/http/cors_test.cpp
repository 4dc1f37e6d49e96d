#include "server/http/cors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/code_of.hpp"

namespace roadfix::http {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;

Response opened(const std::string& origin) {
  Response response;
  Cors(origin).open(response);
  return response;
}

TEST(Cors, RefusesAnOriginThatNoBrowserSends) {
  for (const char* origin : {"", "https://ops.example.org", "http://[fd00::1]:3000", "*"}) {
    EXPECT_EQ(roadfix::testing::code_of([&] { opened(origin); }), "no error") << origin;
  }
  for (const char* origin :
       {"https://ops.example.org/", "ops.example.org", "https://", "https://a, https://b", "nonsense"}) {
    EXPECT_EQ(roadfix::testing::code_of([&] { opened(origin); }), "bad-cors-origin") << origin;
  }
}

TEST(Cors, OpensAnswersToNoPageUnlessAnOriginIsGiven) { EXPECT_THAT(opened("").headers, IsEmpty()); }

TEST(Cors, NamesOneOriginAndTellsCachesThatTheAnswerDependsOnIt) {
  const auto headers = opened("https://ops.example.org").headers;
  EXPECT_THAT(headers, Contains(Pair("Access-Control-Allow-Origin", "https://ops.example.org")));
  EXPECT_THAT(headers, Contains(Pair("Vary", "Origin")));
}

TEST(Cors, OpensAnswersToEveryPageAlike) {
  const auto headers = opened("*").headers;
  EXPECT_THAT(headers, Contains(Pair("Access-Control-Allow-Origin", "*")));
  EXPECT_THAT(headers, Not(Contains(Pair("Vary", "Origin"))));
}

}  // namespace
}  // namespace roadfix::http
