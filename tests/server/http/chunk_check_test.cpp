#include "server/http/chunk_check.hpp"

#include <gmock/gmock.h>

#include "tests/server/http/server_fixture.hpp"

namespace roadfix::http {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

bool are_chunks(const std::string& body, std::size_t piece) {
  ChunkCheck check;
  for (std::size_t at = 0; at < body.size(); at += piece) {
    if (!check.follow(body.substr(at, piece))) return false;
  }
  return true;
}

TEST(ChunkCheck, TakesChunksAsTheStandardHasThem) {
  for (const std::size_t piece : {1UL, 2UL, 5UL, 100UL}) {
    for (const char* body : {"3\r\nabc\r\n0\r\n\r\n", "3;a=b\r\nabc\r\nA\r\n0123456789\r\n0\r\nX: y\r\n\r\n",
                             "03 ;a\r\nabc\r\n000\r\n\r\n", "2\r\n\n\r\r\n0\r\n\r\n", "0\r\nX: y\r\nZ:\r\n\r\nGET /"}) {
      EXPECT_TRUE(are_chunks(body, piece)) << body;
    }
  }
}

TEST(ChunkCheck, RefusesWhatOthersMayReadDifferently) {
  for (const std::size_t piece : {1UL, 2UL, 5UL, 100UL}) {
    for (const char* body : {"0x3\r\nabc\r\n0\r\n\r\n", "3\nabc\n0\n\n", "3\r\nabc\n0\r\n\r\n", "3\r\nabcd\r\n",
                             "-1\r\n", "+3\r\nabc", " 3\r\nabc", "\r\n", ";a\r\n", "3;a\nabc", "0\n\n", "0\r\n\n",
                             "0\r\nX: y\n\r\n", "0\r\nX: y\r\r\n", "0\r\nX: y\r\n\r\r", "ffffffffffffffff\r\nabc"}) {
      EXPECT_FALSE(are_chunks(body, piece)) << body;
    }
  }
}

class HttpServerFraming : public testing::HttpServerTest {};

constexpr const char* kNext = "GET /echo?text=smuggled HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";

TEST_F(HttpServerFraming, TakesNothingBehindABadChunkForARequest) {
  const auto server = started();
  const std::string head = "POST /length HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (const char* body : {"0x3\r\nabc\r\n0\r\n\r\n", "3\nabc\n0\n\n", "3\r\nabc\n", "3\r\nabcde\r\n"}) {
    const std::string answer = raw(head + body + kNext);
    EXPECT_THAT(answer, HasSubstr("bad-body-encoding")) << body;
    EXPECT_THAT(answer, HasSubstr("Connection: close")) << body;
    EXPECT_THAT(answer, Not(HasSubstr("smuggled"))) << body;
  }
  EXPECT_THAT(raw(head + "3\r\nabc\r\n0\r\n\r\n" + kNext), HasSubstr("smuggled")) << "the next request";
}

TEST_F(HttpServerFraming, TakesTrailersAndTheRequestBehindThem) {
  const auto server = started();
  const std::string body = "POST /length HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n";
  for (const char* trailers : {"X-Checksum: abc\r\n", "a:1\r\nb: \r\n"}) {
    const std::string answer = raw(body + trailers + "\r\n" + kNext);
    EXPECT_THAT(answer, HasSubstr("\r\n\r\n3HTTP/1.1 200 OK")) << trailers;
    EXPECT_THAT(answer, HasSubstr("smuggled")) << "the next request";
  }
  EXPECT_THAT(raw(body + "X-Checksum: abc\n\r\n" + kNext), HasSubstr("bad-body-encoding"));
}

TEST_F(HttpServerFraming, RefusesTrailersAsLongAsNoHeadMayBe) {
  settings_.connection.head_bytes = 1000;
  const auto server = started();
  const std::string body = "POST /length HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n";
  EXPECT_THAT(raw(body + "X: " + std::string(2000, 'y') + "\r\n\r\n"), HasSubstr("bad-body-encoding"));
}

TEST_F(HttpServerFraming, ClosesAfterALengthThatSaysNothing) {
  const auto server = started();
  for (const char* length : {"Content-Length:\r\n", "Content-Length: \r\n", ""}) {
    const std::string answer =
        raw("POST /length HTTP/1.1\r\nHost: x\r\n" + std::string(length) + "\r\nabc" + std::string(kNext));
    EXPECT_THAT(answer, HasSubstr("length-required")) << length;
    EXPECT_THAT(answer, HasSubstr("Connection: close")) << length;
    EXPECT_THAT(answer, Not(HasSubstr("smuggled"))) << length;
  }
  EXPECT_THAT(raw("POST /nowhere HTTP/1.1\r\nHost: x\r\nContent-Length:\r\n\r\nabc" + std::string(kNext)),
              Not(HasSubstr("smuggled")));
}

}  // namespace
}  // namespace roadfix::http
