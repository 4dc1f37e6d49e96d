#include "core/units/json_file.hpp"

#include <gmock/gmock.h>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

using ::testing::StrEq;
using ::testing::ThrowsMessage;

const JsonFile kFile{"recipe", "recipe-field", "recipe-json", "ask the cook"};

class JsonFields : public ::testing::Test {
 protected:
  const nlohmann::json document_ = parse_json(
      R"({"name": "pie", "eggs": 3, "share": 0.5, "vegan": false, "steps": [{"do": "stir", "minutes": 2}]})", kFile);
  const JsonField root_{document_, kFile};
};

TEST_F(JsonFields, GiveTheirValues) {
  EXPECT_EQ(root_.at("name").text(), "pie");
  EXPECT_EQ(root_.at("eggs").whole_number(0, 12), 3);
  EXPECT_EQ(root_.at("share").number(0.0, 1.0), 0.5);
  EXPECT_FALSE(root_.at("vegan").truth());
  ASSERT_EQ(root_.at("steps").elements().size(), 1U);
  EXPECT_EQ(root_.at("steps").elements()[0].at("do").one_of({"stir", "bake"}), "stir");
  EXPECT_FALSE(root_.has("oven"));
}

TEST_F(JsonFields, NameTheirPlaceWhereTheyAreWrong) {
  const auto expect = [](const auto& act, const char* message) {
    EXPECT_THAT(act, ThrowsMessage<InvalidInput>(StrEq(message)));
  };
  const auto step = [&] { return root_.at("steps").elements()[0]; };
  expect([&] { root_.at("oven"); }, "recipe: the document lacks the field 'oven'; ask the cook");
  expect([&] { step().at("minutes").text(); }, "recipe: steps[0].minutes must be a string; ask the cook");
  expect([&] { step().at("minutes").number(3.0, 9.0); },
         "recipe: steps[0].minutes is 2; it must lie within 3 to 9; ask the cook");
  expect(
      [&] {
        step().at("do").one_of({"bake", "boil"});
      },
      "recipe: steps[0].do is 'stir'; it must be one of: bake, boil; ask the cook");
  expect([&] { step().allow_only({"do"}); },
         "recipe: steps[0] has the unknown field 'minutes'; known are: do; ask the cook");
  expect([&] { root_.at("share").whole_number(0.0, 1.0); }, "recipe: share must be a whole number; ask the cook");
  expect([&] { root_.at("name").at("first"); }, "recipe: name must be an object; ask the cook");
  expect([&] { root_.at("eggs").elements(); }, "recipe: eggs must be an array; ask the cook");
  expect([&] { root_.at("eggs").truth(); }, "recipe: eggs must be true or false; ask the cook");
}

TEST(JsonFiles, SayWhatIsNoJsonAndWhatIsGivenTwice) {
  const auto code_of = [](const char* text) -> std::string {
    try {
      parse_json(text, kFile);
    } catch (const InvalidInput& error) {
      return error.code();
    }
    return "accepted";
  };
  EXPECT_EQ(code_of("{\"a\": 1}"), "accepted");
  EXPECT_EQ(code_of("{\"a\": 1"), "recipe-json");
  EXPECT_EQ(code_of("{\"a\": 1e999}"), "recipe-json");
  EXPECT_EQ(code_of("{\"a\": 1, \"a\": 1}"), "recipe-field");
}

}  // namespace
}  // namespace roadfix
