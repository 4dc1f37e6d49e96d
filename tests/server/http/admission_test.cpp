#include "server/http/admission.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "server/http/errors.hpp"
#include "server/http/message.hpp"
#include "tests/support/eventually.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using testing::eventually;

TEST(Admission, RefusesWhatComesWhenTheQueueIsFull) {
  Admission admission(1, 0);
  const auto ticket = admission.enter("a", Clock::now() + 1s);
  EXPECT_THROW(admission.enter("a", Clock::now() + 1s), Busy);
}

TEST(Admission, GivesUpAtTheDeadlineAndLeavesNoPlaceBehind) {
  Admission admission(1, 4);
  {
    const auto ticket = admission.enter("a", Clock::now() + 1s);
    EXPECT_THROW(admission.enter("a", Clock::now() + 5ms), Busy);
    EXPECT_EQ(admission.waiting(), 0);
  }
  EXPECT_NO_THROW(admission.enter("a", Clock::now() + 1s));
}

TEST(Admission, LetsGoOfWhatWasAbandonedAndLeavesNoPlaceBehind) {
  Admission admission(1, 4);
  const auto ticket = admission.enter("a", Clock::now() + 1s);
  std::atomic<bool> abandoned = false;
  std::atomic<bool> let_go = false;
  {
    const std::jthread waiting([&] {
      try {
        admission.enter("a", Clock::now() + 10min, [&] { return abandoned.load(); });
      } catch (const ClientGone&) {
        let_go = true;
      }
    });
    EXPECT_TRUE(eventually([&] { return admission.waiting() == 1; }));
    abandoned = true;
  }
  EXPECT_TRUE(let_go);
  EXPECT_EQ(admission.waiting(), 0);
}

TEST(Admission, LetsThemInInTheOrderTheyCame) {
  Admission admission(1, 8);
  std::vector<int> order;
  std::vector<std::jthread> threads;
  {
    const auto first = admission.enter("a", Clock::now() + 10s);
    for (int i = 0; i < 5; ++i) {
      threads.emplace_back([&, i] {
        const auto ticket = admission.enter("a", Clock::now() + 10s);
        order.push_back(i);  // one at a time: that is what the ticket is for
      });
      EXPECT_TRUE(eventually([&] { return admission.waiting() == i + 1; }));
    }
  }
  threads.clear();
  EXPECT_EQ(order, (std::vector{0, 1, 2, 3, 4}));
}

/// Enters in a thread of its own and writes down whose turn it was; "-" where it was sent away.
std::jthread entering(Admission& admission, const std::string& client, std::vector<std::string>& order) {
  const int before = admission.waiting();
  std::jthread thread([&admission, client, &order] {
    try {
      const auto ticket = admission.enter(client, Clock::now() + 60s);
      order.push_back(client);
    } catch (const Busy&) {
      order.emplace_back("-");
    }
  });
  EXPECT_TRUE(eventually([&] { return admission.waiting() == before + 1; }));
  return thread;
}

TEST(Admission, LetsClientsTakeTurnsHoweverManyRequestsOneHas) {
  Admission admission(1, 8);
  std::vector<std::string> order;
  std::vector<std::jthread> threads;
  {
    const auto first = admission.enter("a", Clock::now() + 10s);
    for (const char* client : {"a", "a", "a", "b", "c", "b"}) threads.push_back(entering(admission, client, order));
  }
  threads.clear();
  EXPECT_EQ(order, (std::vector<std::string>{"b", "c", "a", "b", "a", "a"}));
}

TEST(Admission, MakesRoomForAClientThatHasNoneAmongManyOfAnother) {
  Admission admission(1, 3);
  std::vector<std::string> order;
  std::vector<std::jthread> threads;
  {
    const auto first = admission.enter("a", Clock::now() + 10s);
    for (int i = 0; i < 3; ++i) threads.push_back(entering(admission, "a", order));
    EXPECT_THROW(admission.enter("a", Clock::now() + 10s), Busy);
    std::jthread newcomer([&] { const auto ticket = admission.enter("b", Clock::now() + 60s); });
    threads.back().join();
    EXPECT_EQ(order, std::vector<std::string>{"-"}) << "the last of a has made room";
    EXPECT_EQ(admission.waiting(), 3);
    threads.push_back(std::move(newcomer));
  }
}

TEST(Admission, NeverLetsMoreInThanItMay) {
  Admission admission(3, 100);
  std::atomic<int> inside = 0;
  std::atomic<int> max = 0;
  {
    std::vector<std::jthread> threads;
    const std::array tickets{admission.enter("a", Clock::now() + 10s), admission.enter("a", Clock::now() + 10s),
                             admission.enter("a", Clock::now() + 10s)};
    for (int i = 0; i < 24; ++i) {
      threads.emplace_back([&] {
        const auto ticket = admission.enter("a", Clock::now() + 60s);
        const int now = ++inside;
        int seen = max;
        while (now > seen && !max.compare_exchange_weak(seen, now)) {
        }
        std::this_thread::sleep_for(1ms);
        --inside;
      });
    }
    EXPECT_TRUE(eventually([&] { return admission.waiting() == 24; }));
    EXPECT_EQ(admission.running(), 3);
  }
  EXPECT_GE(max, 1);
  EXPECT_LE(max, 3);
  EXPECT_EQ(admission.running(), 0);
}

}  // namespace
}  // namespace roadfix::http
