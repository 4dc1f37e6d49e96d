#include "server/api/track_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadfix::api {
namespace {

std::string answer_at(double lon_deg) {
  return nlohmann::json{{"sequence", 1},
                        {"time_us", 1},
                        {"status", "converged"},
                        {"geometry", {{"type", "Point"}, {"coordinates", {lon_deg, -17.0}}}},
                        {"pose", {{"heading_deg", 90.0}}},
                        {"sigma_m", {1.0, 1.0}},
                        {"ellipse_heading_deg", 0.0},
                        {"heading_sigma_deg", 1.0}}
      .dump();
}

nlohmann::json line_of(const std::vector<std::string>& answers) {
  return history_json(answers)["features"].back()["geometry"];
}

TEST(TrackHistory, SaysOfEachStepHowItWasToldAndByWhat) {
  const nlohmann::json properties{{"sequence", 7},         {"time_us", 8},
                                  {"status", "searching"}, {"doubt", 0.2},
                                  {"drifts", false},       {"measurement", "rejected"},
                                  {"resets", 1},           {"made_by", {{"roadfix", "0.1.0"}}}};
  nlohmann::json answer = properties;
  answer["clusters"] = nlohmann::json::array();
  const nlohmann::json history = history_json(std::vector<std::string>{answer.dump()});
  EXPECT_EQ(history["features"][0]["properties"], properties);
}

TEST(TrackHistory, DrawsNoLineThroughStepsAtWhichNothingWasClaimed) {
  const std::string lost = R"({"sequence": 2, "time_us": 2, "status": "searching"})";
  EXPECT_EQ(line_of({answer_at(10), answer_at(11), lost, lost, answer_at(14), answer_at(15), lost, answer_at(17)}),
            nlohmann::json::parse(R"({"type": "MultiLineString",
                "coordinates": [[[10.0, -17.0], [11.0, -17.0]], [[14.0, -17.0], [15.0, -17.0]]]})"));
  EXPECT_EQ(line_of({lost, answer_at(10), lost, answer_at(11), answer_at(12)})["type"], "LineString");
  EXPECT_EQ(line_of({answer_at(10), lost, answer_at(11)})["type"], "Point") << "no two in a row";
}

TEST(TrackHistory, EndsWithTheFlightAsALineThatIsCutAt180Degrees) {
  EXPECT_EQ(line_of({answer_at(178.5), answer_at(179.5)}),
            nlohmann::json::parse(R"({"type": "LineString", "coordinates": [[178.5, -17.0], [179.5, -17.0]]})"));
  EXPECT_EQ(line_of({answer_at(179.5), answer_at(-179.5)}), nlohmann::json::parse(R"({"type": "MultiLineString",
      "coordinates": [[[179.5, -17.0], [180.0, -17.0]], [[-180.0, -17.0], [-179.5, -17.0]]]})"));
}

}  // namespace
}  // namespace roadfix::api
