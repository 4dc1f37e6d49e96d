#include "cli/fly/service_answer.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/track_json.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::fly {
namespace {

using nlohmann::json;
using testing::code_of;

TrackEstimate estimate() {
  TrackEstimate e;
  e.sequence = 7;
  e.time_us = 8'000'001;
  e.unclaimed.reset();
  e.clusters = {{{{37.7612345678, 38.2712345678}, Angle::degrees(211.5)},
                 0.9375,
                 {{4.25, 3.5}, Angle::degrees(17.0)},
                 Angle::degrees(0.75),
                 9.5,
                 1.0625,
                 0.015625},
                {{{37.77, 38.28}, Angle::degrees(10.0)}, 0.0625, {{8.0, 6.0}, Angle()}, Angle::degrees(2.0), 20.0}};
  e.cluster_count = 11;
  e.particles = 1234;
  e.resets = 1;
  e.measurement = Measurement::kRejected;
  e.mean_likelihood = 0.75;
  e.doubt = 0.125;
  e.since_accepted_s = 2.5;
  e.odometry_is_wrong = true;
  e.missed_steps = 3;
  return e;
}

TEST(ServiceAnswers, AreReadBackAsTheyWereWritten) {
  const json answer = api::to_json(estimate());
  const TrackEstimate read = estimate_of(answer);
  EXPECT_EQ(api::to_json(read), answer);
  EXPECT_EQ(read.measurement, Measurement::kRejected);
  EXPECT_EQ(read.since_accepted_s, 2.5);
  EXPECT_EQ(read.clusters.at(1).radius95_m, 20.0);
  EXPECT_EQ(read.clusters.at(0).scale, 1.0625);
  const std::vector<GeoPose> particles = particles_of(api::particles_json(
      std::vector<GeoPose>{{{37.5, 38.5}, Angle::degrees(90.0)}, {{37.6, 38.6}, Angle::degrees(180.0)}}));
  ASSERT_EQ(particles.size(), 2U);
  EXPECT_EQ(particles[1].position.lat_deg, 37.6);
  EXPECT_NEAR(particles[1].heading.degrees(), 180.0, 1e-9);
}

TEST(ServiceAnswers, SayWhyNoPlaceIsClaimed) {
  for (const auto& [word, why] : kUnclaimed) {
    TrackEstimate searching = estimate();
    searching.unclaimed = why;
    const json answer = api::to_json(searching);
    EXPECT_EQ(answer["status"], "searching");
    EXPECT_EQ(answer["reason"], word);
    EXPECT_EQ(answer["explanation"], explanation_of(why));
    EXPECT_EQ(estimate_of(answer).unclaimed, why);
  }
  EXPECT_FALSE(api::to_json(estimate()).contains("reason"));
}

TEST(ServiceAnswers, OfAnotherProgramAreRefused) {
  const auto refusal = [](const json& answer) { return code_of([&] { estimate_of(answer); }); };
  const json good = api::to_json(estimate());
  EXPECT_EQ(refusal(good), "no error");
  for (const auto& [name, value] : good.items()) {
    if (name == "pose" || name == "geometry" || name == "weight" || !value.is_primitive()) continue;
    json bad = good;
    bad.erase(name);
    const bool repeated_in_clusters = good["clusters"][0].contains(name);
    EXPECT_EQ(refusal(bad), repeated_in_clusters ? "no error" : "service-answer-unreadable") << name;
  }
  json bad = good;
  bad["measurement"] = "guessed";
  EXPECT_EQ(refusal(bad), "service-answer-unreadable");
  bad = good;
  bad["status"] = "searching";
  EXPECT_EQ(refusal(bad), "service-answer-unreadable") << "no reason";
  bad["reason"] = "tired";
  EXPECT_EQ(refusal(bad), "service-answer-unreadable");
  bad = good;
  bad["clusters"] = json::array();
  EXPECT_EQ(refusal(bad), "service-answer-unreadable");
  EXPECT_EQ(refusal(json::array()), "service-answer-unreadable");
  EXPECT_EQ(refusal("hello"), "service-answer-unreadable");
  EXPECT_EQ(code_of([] { particles_of(json::parse("[[1, 2]]")); }), "service-answer-unreadable");
}

TEST(ServiceAnswers, HaveTheVersionsOfTheMaps) {
  const json list = json::parse(R"({"maps": [7, {"name": "bad", "status": "unreadable"}, {"name": 3, "version": "c"},
                                              {"name": "city", "version": "a"}, {"name": "town", "version": "b"}]})");
  EXPECT_EQ(version_in(list, "town"), "b");
  EXPECT_EQ(version_in(list, "bad"), std::nullopt);
  EXPECT_EQ(version_in(list, "nowhere"), std::nullopt);
  for (const json& other : {json({{"maps", 3}}), json::array(), json("hello"), json()}) {
    EXPECT_EQ(code_of([&] { version_in(other, "town"); }), "service-answer-unreadable") << other;
  }
}

TEST(ServiceAnswers, ToATrackThatBeginsHaveItsId) {
  EXPECT_EQ(track_id_of({{"id", "k3"}, {"map", "town"}}), "k3");
  for (const json& other : {json({{"id", 3}}), json({{"map", "town"}}), json::array(), json("hello"), json()}) {
    EXPECT_EQ(code_of([&] { track_id_of(other); }), "service-answer-unreadable") << other;
  }
}

}  // namespace
}  // namespace roadfix::fly
