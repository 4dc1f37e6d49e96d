#include "server/api/track_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/code_of.hpp"

namespace roadfix::api {
namespace {

using testing::code_of;

TrackerState flown() {
  TrackerState state;
  state.started = true;
  state.searched = true;
  state.sequence = 41;
  state.time_us = 42'000'000;
  state.measured = 40;
  state.last_search = 11;
  state.claim = {4, 7.5, true};
  state.accepted_time_us = 42'000'000;
  state.claim.looked_time_us = 40'000'000;
  state.motion.drifts = true;
  state.nadir_sigma_m = 5.25;
  state.motion.velocity = BodyVelocity{14.5, -0.25};
  state.motion.coasts = true;
  state.last_view = {0xfedcba9876543210U, 12.5, 0.25, true, {}};
  state.last_view.earlier.keep(FeatureMap::centred(CellArray(3, 2, kRoad), 4.0));
  return state;
}

TEST(TrackCounters, ComeBackAsTheyWere) {
  EXPECT_TRUE(state_of(counters_json(flown()), {}) == flown());
  TrackerState blind = flown();
  blind.accepted_time_us.reset();
  blind.claim.looked_time_us.reset();
  blind.motion.velocity.reset();
  EXPECT_TRUE(state_of(counters_json(blind), {}) == blind);
}

TEST(TrackCounters, ThatAreNotWholeOrOfAnotherTypeAreRefused) {
  const nlohmann::json good = counters_json(flown());
  for (const auto& member : good.items()) {
    nlohmann::json damaged = good;
    damaged.erase(member.key());
    EXPECT_EQ(code_of([&] { state_of(damaged, {}); }), "track-store-corrupt") << member.key();
  }
  for (const std::string name :
       {"searched", "accepted_time_us", "looked_time_us", "drifts", "velocity", "coasts", "last_view"}) {
    nlohmann::json damaged = good;
    damaged[name] = "soon";
    EXPECT_EQ(code_of([&] { state_of(damaged, {}); }), "track-store-corrupt") << name;
  }
  for (const std::string name : {"sequence", "time_us", "measured", "looked_time_us"}) {
    nlohmann::json damaged = good;
    damaged[name] = 7e111;
    EXPECT_EQ(code_of([&] { state_of(damaged, {}); }), "track-store-corrupt") << name;
  }
}

TEST(TrackCounters, WithAnEarlierViewThatIsDamagedAreRefused) {
  const nlohmann::json good = counters_json(flown());
  const std::string whole = good["last_view"]["earlier"];
  for (const std::string& text :
       {"!" + whole, whole.substr(0, 9) + "!" + whole.substr(10), whole + "!", whole.substr(0, 8)}) {
    nlohmann::json damaged = good;
    damaged["last_view"]["earlier"] = text;
    EXPECT_EQ(code_of([&] { state_of(damaged, {}); }), "track-frames-corrupt") << text;
  }
}

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

TEST(TrackHistory, EndsWithTheFlightAsALineThatIsCutAt180Degrees) {
  const auto line_of = [](const std::vector<std::string>& answers) {
    return history_json(answers)["features"].back()["geometry"];
  };
  EXPECT_EQ(line_of({answer_at(178.5), answer_at(179.5)}),
            nlohmann::json::parse(R"({"type": "LineString", "coordinates": [[178.5, -17.0], [179.5, -17.0]]})"));
  EXPECT_EQ(line_of({answer_at(179.5), answer_at(-179.5)}), nlohmann::json::parse(R"({"type": "MultiLineString",
      "coordinates": [[[179.5, -17.0], [180.0, -17.0]], [[-180.0, -17.0], [-179.5, -17.0]]]})"));
}

}  // namespace
}  // namespace roadfix::api
