#include "server/http/worker_pool.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <latch>
#include <system_error>
#include <thread>

namespace roadfix::http {
namespace {

/// Room for the stacks of some threads, as long as it lives.
class LittleRoom {
 public:
  LittleRoom() {
    getrlimit(RLIMIT_AS, &before_);
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit little{pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{128} << 20U), before_.rlim_max};
    setrlimit(RLIMIT_AS, &little);
  }
  ~LittleRoom() { setrlimit(RLIMIT_AS, &before_); }
  LittleRoom(const LittleRoom&) = delete;
  LittleRoom& operator=(const LittleRoom&) = delete;

 private:
  rlimit before_{};
};

TEST(WorkerPool, CountsNoJobAsWaitingThatAnIdleThreadIsAboutToTake) {
  using namespace std::chrono_literals;
  WorkerPool pool(2, 8);
  std::size_t waiting = 0;
  for (int i = 0; i < 100; ++i) {
    std::latch ran(1);
    pool.enqueue([&] { ran.count_down(); });
    waiting += pool.waiting();
    ran.wait();
    std::this_thread::sleep_for(1ms);  // until it is idle again, on most machines
  }
  EXPECT_LT(waiting, 50U);
}

TEST(WorkerPool, CountsJobsBeyondItsThreadsAsWaiting) {
  std::latch end(1);
  std::latch busy(2);
  WorkerPool pool(2, 8);
  for (int i = 0; i < 2; ++i) {
    pool.enqueue([&] {
      busy.count_down();
      end.wait();
    });
  }
  busy.wait();
  for (int i = 0; i < 3; ++i) pool.enqueue([] {});
  EXPECT_EQ(pool.waiting(), 3U);
  end.count_down();
}

TEST(WorkerPool, SaysWhereAThreadCannotBeStarted) {
  const LittleRoom room;
  EXPECT_THROW(WorkerPool(1000, 1), std::system_error);
}

}  // namespace
}  // namespace roadfix::http
