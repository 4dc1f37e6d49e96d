#include "core/units/utc_text.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

using std::chrono::milliseconds;
using std::chrono::system_clock;

TEST(UtcText, IsToTheMillisecondBelow) {
  const system_clock::time_point time(milliseconds(1'700'000'000'007));
  EXPECT_EQ(utc_text(time), "2023-11-14T22:13:20.007Z");
  EXPECT_EQ(utc_text(time + std::chrono::microseconds(992'999)), "2023-11-14T22:13:20.999Z");
  EXPECT_EQ(utc_text(system_clock::time_point(milliseconds(-1))), "1969-12-31T23:59:59.999Z");
}

}  // namespace
}  // namespace roadfix
