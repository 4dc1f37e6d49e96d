#include "server/api/fields.hpp"

#include <gmock/gmock.h>

#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;
using nlohmann::json;

std::string code_of(const auto& action) {
  try {
    action();
    return "";
  } catch (const InvalidField& error) {
    return error.code() + " " + error.field();
  }
}

TEST(Fields, ReadNumbersFromTextAndFromJsonAlike) {
  Fields fields(http::Parameters{{"lat", "57.7"}});
  const std::vector<std::string> known{"lon", "cols"};
  fields.add(json{{"lon", 11.97}, {"cols", 12}}, known);
  EXPECT_EQ(fields.number("lat", kLatitude), 57.7);
  EXPECT_EQ(fields.number("lon", kLongitude), 11.97);
  EXPECT_EQ(fields.integer("cols", 1, 100), 12);
  EXPECT_EQ(fields.optional_number("radius_m", kPositive), std::nullopt);
}

TEST(Fields, AreSummedUpTheSameInAnyOrder) {
  const std::vector<std::string> known{"lon", "cols", "format"};
  const auto summary = [&](const char* body) {
    Fields fields(http::Parameters{{"lat", "57.7"}});
    fields.add(json::parse(body), known);
    return fields.summary(std::vector<std::string>{"format"});
  };
  EXPECT_EQ(summary(R"({"lon": 11.97, "cols": 12})"), summary(R"({"cols":12,"format":"nmea","lon":11.97})"));
  EXPECT_NE(summary(R"({"lon": 11.97, "cols": 12})"), summary(R"({"lon": 11.97, "cols": 13})"));
  EXPECT_NE(summary(R"({"lon": 11.97, "cols": 12})"), summary(R"({"lon": 11.97})"));
}

TEST(Fields, RefuseWhatIsNoFiniteNumberInRange) {
  for (const char* text : {"", "abc", "1e999", "nan", "inf", "-inf", "1,5", "1 ", " 1", "0x10", "1e"}) {
    const Fields fields(http::Parameters{{"lat", text}});
    EXPECT_EQ(code_of([&] { fields.number("lat", kLatitude); }), "bad-parameter lat") << text;
  }
  const Fields fields(http::Parameters{{"lat", "90.1"}, {"width_m", "0"}, {"height_m", "-3"}, {"cols", "1.5"}});
  EXPECT_EQ(code_of([&] { fields.number("lat", kLatitude); }), "parameter-out-of-range lat");
  EXPECT_EQ(code_of([&] { fields.number("width_m", kPositive); }), "parameter-out-of-range width_m");
  EXPECT_EQ(code_of([&] { fields.number("height_m", kPositive); }), "parameter-out-of-range height_m");
  EXPECT_EQ(code_of([&] { fields.integer("cols", 1, 10); }), "bad-parameter cols");
  EXPECT_EQ(code_of([&] { fields.number("lon", kLongitude); }), "missing-parameter lon");
}

TEST(Fields, SayHowSeveralNumbersAreGiven) {
  const std::vector<std::string> known{"bbox"};
  const auto complaint = [](const Fields& fields) -> std::string {
    try {
      fields.optional_numbers("bbox", 4);
      return "none";
    } catch (const InvalidField& error) {
      return error.what();
    }
  };
  EXPECT_THAT(complaint(Fields(http::Parameters{{"bbox", "1 2 3 4"}})), ::testing::HasSubstr("4 numbers with commas"));
  Fields body;
  body.add(json{{"bbox", "1,2,3,4"}}, known);
  EXPECT_THAT(complaint(body), ::testing::HasSubstr("4 numbers in one flat list"));
  Fields rows;
  rows.add(json{{"bbox", {{1, 2}, {3, 4}}}}, known);
  EXPECT_THAT(complaint(rows), ::testing::HasSubstr("4 numbers in one flat list, not '[[1,2],[3,4]]'"));
}

TEST(Fields, GiveALongTextAwayOnce) {
  Fields fields;
  fields.add({{"image", "abc"}, {"cell_m", 2}}, std::vector<std::string>{"image", "cell_m"});
  EXPECT_EQ(fields.take_text("image"), "abc");
  EXPECT_FALSE(fields.has("image"));
  EXPECT_THROW(fields.take_text("image"), http::InvalidField);
  EXPECT_THROW(fields.take_text("cell_m"), http::InvalidField);
  EXPECT_TRUE(fields.has("cell_m"));
}

TEST(Fields, ReadWholeNumbersAsLargeAsJsonHoldsExactly) {
  const Fields fields(http::Parameters{{"after", "4294967297"}, {"least", "-1"}, {"odd", "0.5"}, {"most", "1e16"}});
  EXPECT_EQ(fields.large_integer("after", -1), 4294967297);
  EXPECT_EQ(fields.optional_large_integer("least", -1), -1);
  EXPECT_EQ(fields.optional_large_integer("none", -1), std::nullopt);
  EXPECT_EQ(code_of([&] { fields.large_integer("least", 0); }), "parameter-out-of-range least");
  EXPECT_EQ(code_of([&] { fields.large_integer("odd", 0); }), "bad-parameter odd");
  EXPECT_EQ(code_of([&] { fields.large_integer("most", 0); }), "parameter-out-of-range most");
  EXPECT_EQ(code_of([&] { fields.large_integer("none", 0); }), "missing-parameter none");
}

TEST(Fields, RefuseJsonMembersOfAnotherTypeUnknownOnesAndRepeatedOnes) {
  const std::vector<std::string> known{"lat", "image"};
  Fields fields(http::Parameters{{"lat", "1"}});
  EXPECT_EQ(code_of([&] { fields.add(json{{"lat", 2}}, known); }), "duplicate-parameter lat");
  EXPECT_EQ(code_of([&] { fields.add(json{{"latt", 2}}, known); }), "unknown-field latt");
  EXPECT_EQ(code_of([&] { fields.add(json::array(), known); }), "bad-json body");
  Fields wrong;
  wrong.add(json{{"lat", "57"}, {"image", 5}}, known);
  EXPECT_EQ(code_of([&] { wrong.number("lat", kLatitude); }), "bad-parameter lat");
  EXPECT_EQ(code_of([&] { wrong.text("image"); }), "bad-parameter image");
}

TEST(Fields, ReadTrueAndFalse) {
  Fields fields(http::Parameters{{"yes", "true"}, {"no", "false"}, {"maybe", "1"}});
  fields.add(json{{"so", true}, {"not", false}, {"word", "true"}}, std::vector<std::string>{"so", "not", "word"});
  for (const char* name : {"yes", "so"}) EXPECT_TRUE(fields.flag(name)) << name;
  for (const char* name : {"no", "not", "none"}) EXPECT_FALSE(fields.flag(name)) << name;
  for (const char* name : {"maybe", "word"}) {
    EXPECT_EQ(code_of([&] { fields.flag(name); }), std::string("bad-parameter ") + name);
  }
}

TEST(Fields, ReadListsOfNumbers) {
  const Fields text(http::Parameters{
      {"bbox", "1,2.5,-3,4"}, {"short", "1,2"}, {"long", "1,2,3,4,5"}, {"odd", "1,,3,4"}, {"blanks", "1, 2,3 ,4"}});
  EXPECT_THAT(*text.optional_numbers("bbox", 4), ::testing::ElementsAre(1, 2.5, -3, 4));
  EXPECT_THAT(*text.optional_numbers("blanks", 4), ::testing::ElementsAre(1, 2, 3, 4));
  for (const char* name : {"short", "long", "odd"}) {
    EXPECT_EQ(code_of([&] { text.optional_numbers(name, 4); }), std::string("bad-parameter ") + name);
  }
  EXPECT_THAT(*text.optional_numbers("long", 4, 5), ::testing::ElementsAre(1, 2, 3, 4, 5));
  Fields array;
  const std::vector<std::string> known{"bbox"};
  array.add(json{{"bbox", {1, 2, 3, 4}}}, known);
  EXPECT_THAT(*array.optional_numbers("bbox", 4), ::testing::ElementsAre(1, 2, 3, 4));
  for (const Fields* fields : {&text, static_cast<const Fields*>(&array)}) {
    EXPECT_EQ(code_of([&] { fields->optional_numbers("bbox", 1, 3); }), "bad-parameter bbox");
    EXPECT_EQ(code_of([&] { fields->optional_numbers("bbox", 5, 8); }), "bad-parameter bbox");
  }
}

}  // namespace
}  // namespace roadfix::api
