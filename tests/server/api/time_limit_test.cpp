#include "server/api/time_limit.hpp"

#include <gtest/gtest.h>

#include "tests/support/code_of.hpp"

namespace roadfix::api {
namespace {

TEST(SearchEnd, LeavesTimeForTheAnswer) {
  const auto soon = http::Clock::now() + std::chrono::hours(1);
  EXPECT_FALSE(search_end(soon, {}).over());
  EXPECT_TRUE(search_end(soon, {}, 0.0).over());
  EXPECT_EQ(testing::code_of([] { search_end(http::Clock::now(), {}); }), "request-deadline");
}

}  // namespace
}  // namespace roadfix::api
