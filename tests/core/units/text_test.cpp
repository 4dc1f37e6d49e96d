#include "core/units/text.hpp"

#include <gmock/gmock.h>

namespace roadfix {
namespace {

using ::testing::ElementsAre;
using ::testing::Optional;

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

TEST(Shortened, SaysThatThereWasMore) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc...");
  EXPECT_EQ(shortened("", 3), "");
}

TEST(AsNumber, TakesAllOfTheTextOrNothing) {
  EXPECT_EQ(as_number<int>("-12"), -12);
  EXPECT_EQ(as_number<double>("2.5e3"), 2500.0);
  for (const char* mistaken : {"", " 1", "1 ", "+1", "1,5", "1x", "99999999999"})
    EXPECT_FALSE(as_number<int>(mistaken));
  for (const char* mistaken : {"", "1,5", "1e", "1e999"}) EXPECT_FALSE(as_number<double>(mistaken)) << mistaken;
}

TEST(Split, GivesOnePartMoreThanThereAreSeparators) {
  EXPECT_THAT(split(" a, b c\t,,d", ','), ElementsAre("a", "b c", "", "d"));
  EXPECT_THAT(split("", ','), ElementsAre(""));
  EXPECT_THAT(split("a,", ','), ElementsAre("a", ""));
}

TEST(NumbersIn, AreAllPartsOfTheTextOrNone) {
  EXPECT_THAT(numbers_in("1, -2.5 ,3e2", ','), Optional(ElementsAre(1.0, -2.5, 300.0)));
  EXPECT_THAT(numbers_in<std::uint8_t>("0,255", ','), Optional(ElementsAre(0, 255)));
  for (const char* mistaken : {"", "1,", "1,,2", "1 2", "0x26,1", "-inf,1", "1,nan", "1,2x"})
    EXPECT_FALSE(numbers_in(mistaken, ',')) << mistaken;
  for (const char* mistaken : {"256", "-1", "1.5"}) EXPECT_FALSE(numbers_in<std::uint8_t>(mistaken, ',')) << mistaken;
}

}  // namespace
}  // namespace roadfix
