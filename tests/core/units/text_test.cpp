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

}  // namespace
}  // namespace roadfix
