// Memory that runs out while a connection is accepted, a request is read or answered: at every allocation in turn.
#include <gmock/gmock.h>

#include <cstdlib>
#include <new>

#include "tests/server/http/server_fixture.hpp"

namespace {

enum class Fails { kNone, kOnce, kOn };
std::atomic<Fails> g_fails = Fails::kNone;
std::atomic<int> g_left = 0;            ///< allocations of the server until the first that fails
thread_local bool t_is_spared = false;  ///< the thread is the test's own

bool is_to_fail() {
  if (t_is_spared || g_fails == Fails::kNone) return false;
  const int left = g_left--;
  return left == 0 || (left < 0 && g_fails == Fails::kOn);
}

}  // namespace

/// Take the place of the C++ library's.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (is_to_fail()) throw std::bad_alloc();
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace roadfix::http {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

struct Sent {
  std::string request;
  std::string status;  ///< where there is memory enough
};

std::string get(const std::string& target) {
  return "GET " + target + " HTTP/1.1\r\nHost: x\r\nX-Long: " + std::string(1000, 'x') +
         "\r\nConnection: close\r\n\r\n";
}

class HttpServerMemory : public testing::HttpServerTest, public ::testing::WithParamInterface<Fails> {
 protected:
  void SetUp() override { t_is_spared = true; }
  void TearDown() override { t_is_spared = false; }

  /// What is answered where the server is given memory so many times, and then once not or no more.
  std::string answer_after(int allocations, const std::string& request) {
    g_left = allocations;
    g_fails = GetParam();
    std::string answer = raw(request);
    g_fails = Fails::kNone;
    failed_ = g_left < 0;
    return answer;
  }

  bool failed_ = false;
};

TEST_P(HttpServerMemory, EndsOneConnectionWhereverItRunsOutAndGoesOn) {
  settings_.threads = 1;
  settings_.heavy_running = 1;
  settings_.proxies = Proxies({"127.0.0.1"});
  const auto server = started();
  for (const auto& [request, status] : {
           Sent{get("/echo?text=" + std::string(100, 'x')), "HTTP/1.1 200"},
           Sent{"POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 50\r\nConnection: close\r\n"
                "X-Forwarded-For: 2001:db8:0:1:2:3:4:5\r\n\r\n" +  // longer than a string keeps in itself
                    std::string(50, 'x'),
                "HTTP/1.1 200"},
           Sent{get("/stream"), "HTTP/1.1 200"},
           Sent{get("/nowhere"), "HTTP/1.1 400"},
           Sent{"no request at all\r\n\r\n", "HTTP/1.1 400"},
       }) {
    int unavailable = 0;
    int allocations = 0;
    for (failed_ = true; failed_; ++allocations) {
      SCOPED_TRACE(request.substr(0, 20) + " after allocation " + std::to_string(allocations));
      const std::string answer = answer_after(allocations, request);
      ASSERT_THAT(answer, AnyOf(IsEmpty(), StartsWith(status), StartsWith("HTTP/1.1 503")));
      if (answer.starts_with("HTTP/1.1 503")) ++unavailable;
      ASSERT_THAT(raw(request), StartsWith(status));
    }
    EXPECT_GT(unavailable, allocations / 2) << request;
  }
}

TEST_P(HttpServerMemory, GoesOnWhereItCannotKeepAConnectionForAThread) {
  const auto server = started();
  for (int connection = 0; connection < 40; ++connection) {  // some of them need a new piece of the queue
    answer_after(0, get("/echo?text=a"));
    ASSERT_TRUE(failed_);
  }
  EXPECT_THAT(raw(get("/echo?text=after")), HasSubstr("after"));
}

TEST_P(HttpServerMemory, GoesOnWhereItCannotEvenTurnAConnectionAway) {
  settings_.max_waiting_connections = 0;
  const auto server = started();
  failed_ = true;
  for (int allocations = 0; failed_; ++allocations) {
    answer_after(allocations, get("/echo?text=a"));
    ASSERT_THAT(raw(get("/echo?text=a")), StartsWith("HTTP/1.1 503"));
  }
}

INSTANTIATE_TEST_SUITE_P(Allocations, HttpServerMemory, ::testing::Values(Fails::kOnce, Fails::kOn));

}  // namespace
}  // namespace roadfix::http
