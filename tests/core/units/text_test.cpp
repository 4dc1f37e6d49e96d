#include "core/units/text.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(LowerCase, ChangesTheLettersOfAsciiAlone) {
  EXPECT_EQ(lower_case("Content-TYPE [@Z`z{]"), "content-type [@z`z{]");
  EXPECT_EQ(lower_case("\xC3\x84rger"), "\xC3\x84rger");
  EXPECT_EQ(lower_case(""), "");
}

TEST(Trimmed, TakesSpacesAndTabsFromBothEndsAlone) {
  EXPECT_EQ(trimmed(" \t a b\t "), "a b");
  EXPECT_EQ(trimmed("\na"), "\na");
  EXPECT_EQ(trimmed(" \t"), "");
}

TEST(AsNumber, TakesAllOfTheTextOrNothing) {
  EXPECT_EQ(as_number<int>("-12"), -12);
  EXPECT_EQ(as_number<double>("2.5e3"), 2500.0);
  for (const char* mistaken : {"", " 1", "1 ", "+1", "1,5", "1x", "99999999999"})
    EXPECT_FALSE(as_number<int>(mistaken));
  for (const char* mistaken : {"", "1,5", "1e", "1e999"}) EXPECT_FALSE(as_number<double>(mistaken)) << mistaken;
}

}  // namespace
}  // namespace roadfix
