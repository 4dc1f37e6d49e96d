#include <gmock/gmock.h>

#include <array>
#include <optional>
#include <string>

#include "cli/date_check.hpp"
#include "cli/number_checks.hpp"
#include "cli/word_option.hpp"

namespace roadfix::cli {
namespace {

std::string complaint(const CLI::Validator& check, std::string text) { return check(text); }

TEST(IsoDate, IsAsExactAsItIsKnown) {
  for (const char* date : {"2023", "2023-02", "2023-02-06", "2024-02-29", "2023-02-06T10:30", "2023-02-06T10:30:05Z",
                           "2023-02-06T10:30:05.25+03:00"}) {
    EXPECT_EQ(complaint(iso_date(), date), "") << date;
  }
}

TEST(IsoDate, IsNoWordNoOtherOrderAndNoDayThatIsNotInTheCalendar) {
  for (const char* date : {"yesterday", "23", "06.02.2023", "2023/02/06", "2023-2-6", "2023-13", "2023-00",
                           "2023-02-30", "2023-02-29", "2023-02-06 10:30", "2023-02-06T24:10", "2023-02-06T"}) {
    EXPECT_NE(complaint(iso_date(), date), "") << date;
  }
  EXPECT_EQ(complaint(iso_date(), "yesterday"),
            "must be a date like 2023, 2023-02, 2023-02-06 or 2023-02-06T10:30Z (ISO 8601), not yesterday");
}

TEST(IsoDate, IsEmptyWhereThereIsToBeNone) { EXPECT_EQ(complaint(iso_date(), ""), ""); }

TEST(Seed, IsAWholeNumberThatTheServiceTakesToo) {
  for (const char* number : {"0", "1", "2147483647"}) EXPECT_EQ(complaint(seed(), number), "") << number;
  for (const char* number : {"-1", "2147483648", "1.5", "1e3", "", "one"}) {
    EXPECT_NE(complaint(seed(), number), "") << number;
  }
  EXPECT_EQ(complaint(seed(), "-1"), "must be a whole number from 0 to 2147483647, not -1");
}

TEST(Between, HoldsItsEndsAndTellsThemAsTheyAre) {
  const CLI::Validator share = between(0.5, 0.999999);
  for (const char* number : {"0.5", "0.7", "0.999999"}) EXPECT_EQ(complaint(share, number), "") << number;
  for (const char* number : {"0.4999", "1", "nan", "-inf", "", "half"}) EXPECT_NE(complaint(share, number), "");
  EXPECT_EQ(complaint(share, "nan"), "must be a number of at least 0.5 and at most 0.999999, not nan");
  EXPECT_EQ(complaint(positive(), "0"), "must be a number above 0 and at most 2000000000, not 0");
}

enum class Dish { kSoup, kStew };
constexpr std::array<Word<Dish>, 2> kDishes{{{"stew", Dish::kStew}, {"soup", Dish::kSoup}}};

TEST(WordOption, TakesTheWordsOfItsTableAlone) {
  CLI::App app;
  Dish needed = Dish::kStew;
  std::optional<Dish> wished;
  add_word_option(app, "--dish", kDishes, needed, "");
  add_word_option(app, "--wish", kDishes, wished, "");
  app.parse("--dish soup");
  EXPECT_EQ(needed, Dish::kSoup);
  EXPECT_EQ(wished, std::nullopt);
  app.parse("--wish stew");
  EXPECT_EQ(wished, Dish::kStew);
  for (const std::string other : {"sou", "Soup", "0"}) {
    try {
      app.parse("--dish " + other);
      ADD_FAILURE() << other;
    } catch (const CLI::ValidationError& refused) {
      EXPECT_EQ(std::string(refused.what()), "--dish: " + other + " not in {stew,soup}");
    }
  }
}

TEST(WordOption, NamesItsWordsInTheHelp) {
  CLI::App app;
  Dish dish = Dish::kStew;
  add_word_option(app, "--dish", kDishes, dish, "What there is");
  EXPECT_THAT(app.help(), ::testing::HasSubstr("{stew,soup}"));
}

TEST(Milliseconds, AreNoneForNoTimeAlone) {
  EXPECT_EQ(milliseconds(0.0).count(), 0);
  EXPECT_EQ(milliseconds(1e-9).count(), 1) << "0 would be no limit";
  EXPECT_EQ(milliseconds(0.25).count(), 250);
  EXPECT_EQ(milliseconds(kMaxNumber).count(), 2'000'000'000'000);
}

}  // namespace
}  // namespace roadfix::cli
