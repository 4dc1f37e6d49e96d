#include "core/units/names_once.hpp"

#include <gtest/gtest.h>

#include <ctime>
#include <stdexcept>

namespace roadfix {
namespace {

using nlohmann::json;

json read(std::string_view text) {
  return parse_with_names_once(text, [](const std::string& name) { throw std::invalid_argument(name); });
}

TEST(NamesOnce, ReadsWhatTheLibraryReads) {
  for (const char* text :
       {R"({"a": [1, -2, 3.5, 1e300, true, false, null, "x\u00e9\n"], "b": {"a": {}, "c": []}, "": 0})", "[]", "{}",
        "null", " 7 ", R"("text")", "[[[1], 2], {\"a\": [{\"a\": 1}, {\"a\": 2}]}]", "18446744073709551615",
        "-9223372036854775808", "123456789012345678901234567890"}) {
    const json own = read(text);
    EXPECT_EQ(own, json::parse(text)) << text;
    EXPECT_EQ(own.type(), json::parse(text).type()) << text;
  }
}

TEST(NamesOnce, SaysWhatTheLibrarySaysOfWhatIsNoJson) {
  for (const char* text : {"", "{", "[1,]", "{\"a\" 1}", "nul", "[1] 2", "\"\xff\"", "1e999"}) {
    std::string expected;
    try {
      const json parsed = json::parse(text);
    } catch (const json::parse_error& error) {
      expected = error.what();
    } catch (const json::out_of_range& error) {
      expected = error.what();
    }
    std::string said;
    try {
      read(text);
    } catch (const json::parse_error& error) {
      said = error.what();
    } catch (const json::out_of_range& error) {
      said = error.what();
    }
    EXPECT_EQ(said, expected) << text;
    EXPECT_NE(said, "") << text;
  }
}

TEST(NamesOnce, RefusesANameThatAnObjectHasTwice) {
  EXPECT_THROW(read(R"({"a": 1, "b": {}, "a": 1})"), std::invalid_argument);
  EXPECT_THROW(read(R"([{"b": {"a": 1, "\u0061": 2}}])"), std::invalid_argument);
  EXPECT_NO_THROW(read(R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 1}]})"));
}

TEST(NamesOnce, DoesNotLookThroughAnArrayAgainAfterEachOfItsObjects) {
  const auto cpu_ticks = [](int objects) {
    std::string text = "[{}";
    for (int i = 1; i < objects; ++i) text += ",{}";
    const std::clock_t begun = std::clock();
    EXPECT_EQ(read(text + "]").size(), static_cast<std::size_t>(objects));
    return std::clock() - begun;
  };
  cpu_ticks(10'000);
  EXPECT_LT(cpu_ticks(200'000), 100 * cpu_ticks(10'000));  // 20 times; 400 times where it does
}

}  // namespace
}  // namespace roadfix
