#include "tiles/imagery/collar.hpp"

#include <gtest/gtest.h>

#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

TEST(Colour, IsANameOrThreeNumbers) {
  const Rgb grey = parse_colour("1,20,255");
  EXPECT_EQ(grey.red, 1);
  EXPECT_EQ(grey.green, 20);
  EXPECT_EQ(grey.blue, 255);
  EXPECT_EQ(parse_colour("white").green, 255);
  EXPECT_EQ(parse_colour("black").green, 0);
  for (const char* text : {"", "grey", "1,2", "1,2,", "1,2,3,", "1,2,3,4", "1,,3", "1,2,256", "-1,2,3", "1 2 3"}) {
    EXPECT_EQ(testing::code_of([&] { parse_colour(text); }), "colour-unknown") << text;
  }
}

}  // namespace
}  // namespace roadfix
