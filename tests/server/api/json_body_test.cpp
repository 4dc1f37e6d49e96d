#include "server/api/json_body.hpp"

#include <gtest/gtest.h>

#include "core/units/error.hpp"
#include "server/http/errors.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::api {
namespace {

TEST(JsonBody, RefusesNestingBeyondTheLimitAtItsByte) {
  const std::string deep(100'000, '[');
  try {
    parse_json(deep, 1000);
    FAIL();
  } catch (const http::InvalidField& error) {
    EXPECT_EQ(error.code(), "json-too-deep");
    EXPECT_EQ(error.byte(), 16U);
  }
  EXPECT_NO_THROW(parse_json(R"({"a":[[["[[[[[[[[[[[[[[[[[[[[[{{{"]]]})", 1000));
}

TEST(JsonBody, RefusesMoreValuesThanAllowedBeforeBuildingThem) {
  std::string poses = R"({"poses":[0)";
  for (int i = 0; i < 2000; ++i) poses += ",0";
  EXPECT_EQ(testing::code_of([&] { parse_json(poses + "]}", 1000); }), "json-too-long");
}

TEST(JsonBody, RefusesAFieldThatIsGivenTwice) {
  for (const char* text : {R"({"cell_m":2,"cell_m":3})", R"({"a":[{"cell_m":1},{"cell_m":2,"cell_m":2}]})",
                           R"({"b":{"cell_m":{"b":1},"cell_m":1}})"}) {
    try {
      parse_json(text);
      FAIL() << text;
    } catch (const http::InvalidField& error) {
      EXPECT_EQ(error.code(), "duplicate-parameter") << text;
      EXPECT_EQ(error.field(), "cell_m");
    }
  }
  EXPECT_NO_THROW(parse_json(R"({"a":{"b":1},"b":{"a":[{"b":1},{"b":2}]}})"));
}

TEST(JsonBody, SaysWhereJsonIsBroken) {
  for (const char* text :
       {"", "{", R"({"a":NaN})", R"({"a":1e999})", "{\"a\":\"\xff\"}", R"({"a":1}x)", R"({"a":"\)"}) {
    try {
      parse_json(text);
      FAIL() << text;
    } catch (const http::InvalidField& error) {
      EXPECT_EQ(error.code(), "bad-json") << text;
      EXPECT_EQ(error.field(), "body");
      EXPECT_EQ(std::string(error.what()).find("json.exception"), std::string::npos) << error.what();
    }
  }
}

TEST(JsonBody, IsNotRepeatedInWhatIsSaidOfIt) {
  const std::string long_text(100'000, '1');
  for (const std::string& text :
       {"{\"a\":" + long_text + "}", "{\"a\":\"" + long_text, "{\"" + long_text + "\":1,\"" + long_text + "\":1}"}) {
    try {
      parse_json(text);
      FAIL() << text.substr(0, 20);
    } catch (const http::InvalidField& error) {
      EXPECT_LT(std::string_view(error.what()).size() + error.field().size(), 1000U) << text.substr(0, 20);
    }
  }
}

}  // namespace
}  // namespace roadfix::api
