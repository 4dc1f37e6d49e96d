#include "server/http/byte_budget.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace roadfix::http {
namespace {

TEST(ByteBudget, RefusesWhatWouldGoBeyondItAndTakesNothing) {
  ByteBudget budget(100);
  ByteBudget::Share one;
  ByteBudget::Share other;
  EXPECT_TRUE(one.take(budget, 60));
  EXPECT_FALSE(other.take(budget, 41));
  EXPECT_TRUE(other.take(budget, 30));
  EXPECT_TRUE(one.take(budget, 10)) << "a share grows";
  EXPECT_FALSE(other.take(budget, 1));
}

TEST(ByteBudget, GetsBackWhatAShareHadWhenItEnds) {
  ByteBudget budget(100);
  {
    ByteBudget::Share share;
    EXPECT_TRUE(share.take(budget, 70));
    EXPECT_TRUE(share.take(budget, 30));
  }
  ByteBudget::Share next;
  EXPECT_TRUE(next.take(budget, 100));
}

TEST(ByteBudget, IsWholeAgainAfterManyThreadsTookFromIt) {
  ByteBudget budget(1000);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&budget] {
      for (int k = 0; k < 2000; ++k) {
        ByteBudget::Share share;
        while (share.take(budget, 70)) {
        }
      }
    });
  }
  threads.clear();
  ByteBudget::Share all;
  EXPECT_TRUE(all.take(budget, 1000));
  EXPECT_FALSE(all.take(budget, 1));
}

}  // namespace
}  // namespace roadfix::http
