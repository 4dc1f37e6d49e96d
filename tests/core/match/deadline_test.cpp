#include "core/match/deadline.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

TEST(Deadline, IsSetByWhatEndsFirst) {
  const Deadline late({}, steady_clock::now() + hours(1));
  EXPECT_FALSE(late.over());
  EXPECT_TRUE(late.within(milliseconds(0)).over());
  EXPECT_FALSE(late.within(hours(2)).over());
  EXPECT_TRUE(Deadline({}, steady_clock::now()).within(hours(1)).over());
  EXPECT_TRUE(Deadline().within(milliseconds(0)).over());
}

TEST(Deadline, OfNoTimeNeverComes) {
  EXPECT_FALSE(Deadline().over());
  EXPECT_FALSE(Deadline().within(std::nullopt).over());
  EXPECT_FALSE(Deadline().after(0.0).over()) << "no share of what has no end";
}

}  // namespace
}  // namespace roadfix
