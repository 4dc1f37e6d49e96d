#include "core/units/words.hpp"

#include <gmock/gmock.h>

namespace roadfix {
namespace {

enum class Dish { kSoup, kStew };
constexpr std::array<Word<Dish>, 2> kDishes{{{"stew", Dish::kStew}, {"soup", Dish::kSoup}}};

TEST(Words, AreReadAndWrittenByOneTable) {
  for (const Dish dish : {Dish::kSoup, Dish::kStew}) EXPECT_EQ(value_of(kDishes, word_of(kDishes, dish)), dish);
  EXPECT_EQ(value_of(kDishes, "soup"), Dish::kSoup);
}

TEST(Words, ThatNoValueHasAreNone) {
  EXPECT_EQ(value_of(kDishes, "sou"), std::nullopt);
  EXPECT_EQ(value_of(kDishes, ""), std::nullopt);
}

TEST(Words, KeepTheOrderOfTheTable) { EXPECT_THAT(words_in(kDishes), ::testing::ElementsAre("stew", "soup")); }

}  // namespace
}  // namespace roadfix
