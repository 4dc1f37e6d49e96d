// Connections that the system cannot hand over: the peer has gone already, or it has no descriptor or memory for them.
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

#include "tests/server/http/server_fixture.hpp"

namespace {

std::atomic<int> g_failing = 0;  ///< of the next calls of accept()
std::atomic<int> g_reason = 0;

}  // namespace

/// Takes the place of the C library's.
extern "C" int accept(int socket, sockaddr* address, socklen_t* size) {
  if (g_failing > 0) {
    --g_failing;
    errno = g_reason;
    return -1;
  }
  return static_cast<int>(syscall(SYS_accept4, socket, address, size, 0));
}

namespace roadfix::http {
namespace {

class HttpServerAccept : public testing::HttpServerTest, public ::testing::WithParamInterface<int> {};

TEST_P(HttpServerAccept, GoesOnWhenAConnectionCannotBeAccepted) {
  g_reason = GetParam();
  const auto server = started();
  ASSERT_TRUE(client().Get("/echo?text=before"));
  g_failing = 3;
  ASSERT_TRUE(client().Get("/echo?text=last"));  // was waited for already
  EXPECT_TRUE(testing::eventually([&] { return g_failing <= 0; }));
  const auto after = client().Get("/echo?text=after");
  ASSERT_TRUE(after) << httplib::to_string(after.error());
  EXPECT_EQ(after->body, "after");
}

INSTANTIATE_TEST_SUITE_P(Reasons, HttpServerAccept, ::testing::Values(ECONNABORTED, ENFILE, ENOBUFS, EINTR));

}  // namespace
}  // namespace roadfix::http
