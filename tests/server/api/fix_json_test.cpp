#include "server/api/fix_json.hpp"

#include <gtest/gtest.h>

#include "server/api/json_parts.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix::api {
namespace {

FixMode mode() {
  FixMode mode;
  mode.pose = {{37.7632, 38.2571}, Angle::degrees(-90.0)};
  mode.scale = 1.05;
  mode.weight = 0.996;
  mode.rho = 0.31;
  mode.ellipse.sigma_m = {2.1, 1.7};
  mode.ellipse.heading = Angle::degrees(40.0);
  mode.heading_sigma = Angle::degrees(0.8);
  mode.observed_cells = 9812;
  return mode;
}

TEST(FixJson, AFixCarriesItsPoseAtTheTop) {
  Fix fix;
  fix.status = FixStatus::kFix;
  fix.probability = 0.996;
  fix.modes = {mode()};
  fix.searched_km2 = 24.6;
  fix.proof = SearchProof{4.0, 472, 1, 0.6, 0.8, false, 0.97};
  fix.headings = 360;
  fix.map.name = "adiyaman";
  Features frame;
  frame.detect_time = std::chrono::milliseconds(140);
  frame.detector = "tree";
  const auto answer = to_json(fix, frame);
  EXPECT_EQ(answer["status"], "fix");
  EXPECT_EQ(answer["pose"]["lat"], 37.7632);
  EXPECT_NEAR(answer["pose"]["heading_deg"].get<double>(), 270.0, 1e-9);
  EXPECT_EQ(answer["geometry"]["coordinates"], (nlohmann::json{38.2571, 37.7632}));
  EXPECT_EQ(answer["scale"], 1.05);
  EXPECT_EQ(answer["rho"], 0.31);
  EXPECT_EQ(answer["sigma_m"], (nlohmann::json{2.1, 1.7}));
  EXPECT_NEAR(answer["ellipse_heading_deg"].get<double>(), 40.0, 1e-9);
  EXPECT_NEAR(answer["heading_sigma_deg"].get<double>(), 0.8, 1e-9);
  EXPECT_EQ(answer["observed_cells"], 9812);
  EXPECT_EQ(answer["modes"][0]["weight"], 0.996);
  EXPECT_FALSE(answer["modes"][0].contains("geometry")) << "its pose says it";
  EXPECT_EQ(answer["searched"]["headings"], 360);
  EXPECT_EQ(answer["searched"]["complete"], true);
  EXPECT_EQ(answer["searched"]["share"], 1.0);
  EXPECT_EQ(answer["searched"]["proof"]["complete"], false);
  EXPECT_EQ(answer["searched"]["proof"]["bound"], 0.8);
  EXPECT_EQ(answer["searched"]["proof"]["excluded_share"], 0.97);
  EXPECT_EQ(answer["map"]["name"], "adiyaman");
  EXPECT_EQ(answer["made_by"], made_by("tree"));
  EXPECT_EQ(answer["made_by"]["detector"], "tree");
  EXPECT_EQ(to_json(fix)["made_by"], made_by()) << "of a feature map nobody knows";
  EXPECT_EQ(answer["time_ms"]["detect"], 140.0);
  EXPECT_FALSE(answer.contains("reason"));
}

TEST(FixJson, WithoutAFixNoPositionStandsAtTheTop) {
  Fix fix;
  fix.status = FixStatus::kAmbiguous;
  fix.reason = "several-places-fit";
  fix.modes = {mode()};
  const auto answer = to_json(fix);
  EXPECT_EQ(answer["status"], "ambiguous");
  EXPECT_EQ(answer["reason"], "several-places-fit");
  EXPECT_FALSE(answer.contains("pose"));
  EXPECT_FALSE(answer.contains("geometry"));
  EXPECT_EQ(answer["modes"].size(), 1U);
  EXPECT_FALSE(answer["time_ms"].contains("detect"));
}

TEST(FixJson, ALocalizabilityNamesThePlacesAlike) {
  Localizability place;
  place.status = FixStatus::kAmbiguous;
  place.reason = "several-places-fit";
  place.probability = 0.4;
  place.alike = {mode()};
  const auto answer = to_json(place);
  EXPECT_EQ(answer["status"], "ambiguous");
  EXPECT_EQ(answer["reason"], "several-places-fit");
  EXPECT_EQ(answer["probability"], 0.4);
  EXPECT_EQ(answer["alike"][0]["pose"]["lat"], 37.7632);
  EXPECT_FALSE(to_json(Localizability{}).contains("reason"));
}

TEST(FixJson, CountsFramesThatWereLeftOutFromTheFirstOn) {
  Features features;
  EXPECT_FALSE(to_json(Fix{}, features).contains("left_out"));
  features.left_out = {0, 3};
  const auto numbers = nlohmann::json::array({1, 4});
  EXPECT_EQ(to_json(Fix{}, features)["left_out"], numbers);
  const MapView map = testing::view_of({{2.0, {0, 0}, 1, 1}, CellArray(1, 1)});
  EXPECT_EQ(to_json(std::span<const MatchScore>(), map, features)["left_out"], numbers);
}

TEST(FixJson, AMatchWithoutCommonCellsHasNoRho) {
  const std::vector<MatchScore> scores{{0.25, 100}, {-0.5, 7}, {std::nullopt, 0}};
  const MapView map = testing::view_of({{2.0, {0, 0}, 1, 1}, CellArray(1, 1)});
  const auto answer = to_json(scores, map, {});
  EXPECT_EQ(answer["map"]["name"], "town");
  EXPECT_EQ(answer["scores"][0], (nlohmann::json{{"rho", 0.25}, {"probability", 0.25}, {"observed_cells", 100}}));
  EXPECT_EQ(answer["scores"][1]["probability"], 0.0);
  EXPECT_TRUE(answer["scores"][2]["rho"].is_null());
}

}  // namespace
}  // namespace roadfix::api
