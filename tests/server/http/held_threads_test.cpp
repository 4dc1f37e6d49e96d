// Threads that are left to what is answered at once, whatever the others are held by.
#include "server/http/held_threads.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "tests/server/http/server_fixture.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using testing::eventually;

TEST(HeldThreads, LeavesAQuarterOfTheThreadsAndEightAtMost) {
  for (const auto& [threads, most] : {std::pair{1, 1}, {3, 3}, {4, 3}, {8, 6}, {64, 56}}) {
    HeldThreads held(threads);
    std::vector<HeldThreads::Share> shares(static_cast<std::size_t>(most));
    for (HeldThreads::Share& share : shares) share.take(held);
    HeldThreads::Share another;
    EXPECT_THROW(another.take(held), Busy) << threads;
    EXPECT_FALSE(held.too_many());
    shares.front().give_back();
    EXPECT_NO_THROW(another.take(held)) << threads;
  }
}

TEST(HeldThreads, LetsWhatMakesRoomTakeHalfOfTheRest) {
  HeldThreads held(8);
  std::array<HeldThreads::Share, 7> shares;
  for (HeldThreads::Share& share : shares) share.take_in_advance(held);
  EXPECT_TRUE(held.too_many());
  HeldThreads::Share another;
  EXPECT_THROW(another.take_in_advance(held), Busy);
}

class HttpServerHeldThreads : public testing::HttpServerTest {
 protected:
  HttpServerHeldThreads() {
    settings_.heavy_running = 1;
    settings_.proxies = Proxies({"127.0.0.1"});
    router_.add({"GET", "/long", {}, Load::kLong, [this](const Request&) {
                   ++long_;
                   while (!go_) std::this_thread::sleep_for(1ms);
                   return Response{200, "text/plain", "waited"};
                 }});
    router_.add({"GET", "/events", {}, Load::kLong, [this](const Request&) {
                   Response response{200, "text/plain", {}};
                   response.stream = [this, first = true]() mutable -> std::optional<std::string> {
                     if (std::exchange(first, false)) return "event ";
                     ++long_;
                     while (!go_) std::this_thread::sleep_for(1ms);
                     return std::nullopt;
                   };
                   return response;
                 }});
  }
  /// Of another client, which waits for its answer while it is in scope.
  std::jthread asked(const std::string& client_name, const std::string& path, int* status = nullptr) {
    return std::jthread([this, client_name, path, status] {
      httplib::Client c = client();
      c.set_read_timeout(60s);
      const httplib::Headers headers{{"X-Forwarded-For", client_name}};
      const auto answer = path == "/wait" ? c.Post(path, headers, "", "text/plain") : c.Get(path, headers);
      if (status != nullptr && answer) *status = answer->status;
    });
  }
  void wait_for_long(int count) const {
    EXPECT_TRUE(eventually([&] { return long_ >= count; }));
  }

  std::atomic<int> long_ = 0;
};

TEST_F(HttpServerHeldThreads, AnswersAtOnceWhileAllOthersWaitRunOrStream) {
  settings_.threads = 8;
  const auto server = started();
  std::vector<std::jthread> others;
  for (int i = 0; i < 2; ++i) others.push_back(asked("192.0.2.1", "/events"));
  for (int i = 0; i < 2; ++i) others.push_back(asked("192.0.2.1", "/long"));
  wait_for_long(4);
  others.push_back(asked("192.0.2.1", "/wait"));
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  others.push_back(asked("192.0.2.1", "/wait"));
  wait_for_figure("roadfix_heavy_waiting 1");
  for (const char* path : {"/long", "/events"}) {
    const auto refused = client().Get(path);
    ASSERT_TRUE(refused) << path;
    EXPECT_EQ(refused->status, 503) << path;
    EXPECT_EQ(refused->body, "server-busy") << path;
  }
  for (int i = 0; i < 20; ++i) EXPECT_EQ(client().Get("/echo?text=alive")->body, "alive");
  go_ = true;
}

TEST_F(HttpServerHeldThreads, MakesTheClientWithTheMostGiveAThreadToAnother) {
  settings_.threads = 8;
  const auto server = started();
  std::vector<int> greedy(6, 0);
  int modest = 0;
  {
    std::vector<std::jthread> others;
    for (int& status : greedy) {
      others.push_back(asked("192.0.2.1", "/wait", &status));
      if (others.size() == 1) {
        EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
      } else {
        wait_for_figure("roadfix_heavy_waiting " + std::to_string(others.size() - 1));
      }
    }
    int refused = 0;
    asked("192.0.2.1", "/wait", &refused).join();
    EXPECT_EQ(refused, 503) << "one more of the same";
    others.push_back(asked("192.0.2.2", "/wait", &modest));
    others[greedy.size() - 1].join();
    go_ = true;
  }
  EXPECT_EQ(greedy.back(), 503) << "the last of the client with the most";
  EXPECT_EQ(modest, 200);
}

}  // namespace
}  // namespace roadfix::http
