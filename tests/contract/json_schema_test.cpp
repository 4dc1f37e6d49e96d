// That the check of real answers and of examples against /openapi.json finds what is wrong.
#include "tests/support/json_schema.hpp"

#include <gmock/gmock.h>

namespace roadfix::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const json kDocument = json::parse(R"({"schemas": {
  "Pose": {"type": "object", "required": ["lat"], "properties": {
    "lat": {"type": "number", "minimum": -90, "maximum": 90, "description": "north"},
    "turn": {"type": ["number", "null"], "exclusiveMinimum": -1, "exclusiveMaximum": 1}}},
  "Answer": {"type": "object", "properties": {
    "status": {"type": "string", "enum": ["fix", "no_fix"]},
    "kind": {"const": "Point"},
    "count": {"type": "integer"},
    "poses": {"type": "array", "minItems": 1, "maxItems": 2, "items": {"$ref": "#/schemas/Pose"}}}}}})");

std::vector<std::string> found(const char* answer) {
  return breaches(kDocument, {{"$ref", "#/schemas/Answer"}}, json::parse(answer));
}

TEST(JsonSchema, FindsNothingInWhatIsAsDescribed) {
  EXPECT_THAT(found(R"({"status": "fix", "kind": "Point", "count": 2, "poses": [{"lat": 90, "turn": null}]})"),
              IsEmpty());
  EXPECT_THAT(breaches(kDocument, {{"type", "object"}}, {{"anything", 1}}), IsEmpty());
}

TEST(JsonSchema, SaysWhatIsNotAsDescribedAndWhere) {
  EXPECT_THAT(found("[]"), ElementsAre(R"($ is array and no "object")"));
  EXPECT_THAT(found(R"({"count": 1.5, "kind": "Line", "status": "lost"})"),
              ElementsAre(R"($.count is number and no "integer")", R"($.kind is not "Point")",
                          R"($.status is none of ["fix","no_fix"])"));
  EXPECT_THAT(found(R"({"colour": 1})"), ElementsAre("$.colour is not described"));
  EXPECT_THAT(found(R"({"poses": []})"), ElementsAre("$.poses has fewer items than 1"));
  EXPECT_THAT(found(R"({"poses": [{"lat": 1}, {"lat": 91}, {"lat": -91, "turn": 1}, {"turn": "left"}]})"),
              ElementsAre("$.poses[1].lat is above 90", "$.poses[2].lat is below -90", "$.poses[2].turn is not below 1",
                          R"($.poses[3].turn is string and no ["number","null"])", R"($.poses[3] lacks "lat")",
                          "$.poses has more items than 2"));
  EXPECT_THAT(found(R"({"poses": [{"lat": 1, "turn": -1}]})"), ElementsAre("$.poses[0].turn is not above -1"));
}

TEST(JsonSchema, SaysWhichWordsOfADescriptionItDoesNotKnow) {
  EXPECT_THAT(breaches(kDocument, {{"pattern", "a+"}}, "b"),
              ElementsAre("$ is described by 'pattern', which nothing checks"));
}

}  // namespace
}  // namespace roadfix::testing
