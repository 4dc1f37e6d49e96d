#include "core/detect/network_description.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

using nlohmann::json;

json example() {
  return json::parse(R"({ "name": "n", "gsd_m": 1.5, "stride": 2, "multiple": 16, "tile_px": 384, "overlap_px": 96,
    "channels": "rgb", "mean": [1, 2, 3], "std": [4, 5, 6], "output": "logits",
    "calibration": { "scale": 0.9, "bias": -0.5 }, "fnv1a64": "af63dc4c8601ec8c" })");
}

std::string refusal_of_text(const std::string& text) {
  try {
    parse_network_description(text);
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.code(), "model-description");
    return error.what();
  }
  return "accepted";
}

std::string refusal(const json& description) { return refusal_of_text(description.dump()); }

TEST(NetworkDescription, ReadsEachField) {
  const auto network = parse_network_description(example().dump());
  EXPECT_EQ(network.name, "n");
  EXPECT_EQ(network.gsd_m, 1.5);
  EXPECT_EQ(network.overlap_px, 96);
  EXPECT_TRUE(network.rgb);
  EXPECT_TRUE(network.logits);
  EXPECT_EQ(network.std[2], 6.0);
  EXPECT_EQ(network.calibration_bias, -0.5);
  EXPECT_EQ(network.fnv1a64, "af63dc4c8601ec8c");
}

TEST(NetworkDescription, NamesAMissingField) {
  const json all = example();
  for (const auto& [name, value] : all.items()) {
    if (name == "fnv1a64") continue;
    json less = all;
    less.erase(name);
    EXPECT_NE(refusal(less).find("lacks the field '" + name + "'"), std::string::npos) << name;
  }
}

TEST(NetworkDescription, RefusesWhatNoNetworkCanMean) {
  const auto with = [](const char* name, const json& value) {
    json changed = example();
    changed[name] = value;
    return refusal(changed);
  };
  EXPECT_NE(with("gsd_m", 0).find("within"), std::string::npos);
  EXPECT_NE(with("gsd_m", "1").find("number"), std::string::npos);
  EXPECT_NE(with("stride", 1.5).find("whole"), std::string::npos);
  EXPECT_NE(with("stride", 3).find("multiple"), std::string::npos);
  EXPECT_NE(with("tile_px", 100).find("multiples"), std::string::npos);
  EXPECT_NE(with("overlap_px", 208).find("half"), std::string::npos);
  EXPECT_NE(with("mean", {1, 2}).find("three"), std::string::npos);
  EXPECT_NE(with("std", {0, 1, 1}).find("std[0] is 0; it must lie within"), std::string::npos);
  EXPECT_NE(with("channels", "grey").find("bgr"), std::string::npos);
  EXPECT_NE(with("calibration", 1).find("object"), std::string::npos);
}

TEST(NetworkDescription, LocalContrastIsOptionalAndItsWindowOdd) {
  EXPECT_FALSE(parse_network_description(example().dump()).local_contrast.has_value());
  json local = example();
  local["local_contrast"] = {{"window_px", 129}, {"floor", 4}};
  EXPECT_EQ(parse_network_description(local.dump()).local_contrast.value().window_px, 129);
  local["local_contrast"]["window_px"] = 128;
  EXPECT_NE(refusal(local).find("odd"), std::string::npos);
  local["local_contrast"] = true;
  EXPECT_NE(refusal(local).find("object"), std::string::npos);
}

TEST(NetworkDescription, RefusesFieldsThatItDoesNotKnow) {
  json changed = example();
  changed["local_contrst"] = {{"window_px", 129}, {"floor", 4}};
  EXPECT_NE(refusal(changed).find("unknown field 'local_contrst'"), std::string::npos);
  changed = example();
  changed["calibration"]["offset"] = 1;
  EXPECT_NE(refusal(changed).find("calibration has the unknown field 'offset'"), std::string::npos);
}

TEST(NetworkDescription, GivesNoNameTwice) {
  const std::string text = example().dump();
  for (const std::string field : {R"("bias":-0.5)", R"("gsd_m":1.5)"}) {
    std::string doubled = text;
    doubled.insert(text.find(field), field + ",");
    EXPECT_NE(refusal_of_text(doubled).find("is given twice"), std::string::npos) << doubled;
  }
}

TEST(NetworkDescription, RefusesTextThatIsNotAnObject) {
  for (const char* text : {"", "{", "[]", "1", "\xff\xfe"}) {
    EXPECT_THROW(parse_network_description(text), InvalidInput) << text;
  }
}

}  // namespace
}  // namespace roadfix
