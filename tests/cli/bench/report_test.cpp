#include "cli/bench/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/bench/queries.hpp"

namespace roadfix::bench {
namespace {

const UtmZone kUtm = UtmZone::containing({37.76, 38.28});

Outcome outcome(FixStatus status, double error_m, double heading_error_deg) {
  const GridPoint truth = kUtm.project({37.76, 38.28});
  Answer answer;
  answer.status = status;
  answer.best =
      GeoPose{kUtm.unproject({truth.east_m + error_m, truth.north_m}), Angle::degrees(350 + heading_error_deg)};
  return judged("q", GeoPose{kUtm.unproject(truth), Angle::degrees(350)}, answer, kUtm);
}

TEST(Summary, CountsRecallOverAllAndErrorsOverTheAnswered) {
  const std::vector<Outcome> outcomes = {outcome(FixStatus::kFix, 3.0, 1.0), outcome(FixStatus::kFix, 40.0, 15.0),
                                         outcome(FixStatus::kAmbiguous, 8.0, 2.0), judged("none", {}, Answer{}, kUtm)};
  const Summary s = summary_of(outcomes);
  EXPECT_EQ(s.n, 4);
  EXPECT_EQ(s.answered, 2);
  EXPECT_EQ(s.false_fixes, 1);
  EXPECT_EQ(s.recall_5, 0.25);
  EXPECT_EQ(s.recall_10, 0.5);
  EXPECT_EQ(s.recall_25, 0.5);
  EXPECT_EQ(s.recall_50, 0.75);
  EXPECT_NEAR(*s.median_error_m, 21.5, 1e-6);
  EXPECT_NEAR(*s.median_heading_error_deg, 8.0, 1e-6);
}

TEST(Summary, TellsWhatOfTheTruePlaceWasSeenAgain) {
  Answer a;
  a.keypoints = {100, 3};
  Answer b;
  b.keypoints = {50, 0};
  const std::vector<Outcome> keypoints = {judged("a", {}, a, kUtm), judged("b", {}, b, kUtm)};
  EXPECT_EQ(summary_of(keypoints).mean_matches, 75.0);
  EXPECT_EQ(summary_of(keypoints).mean_right_matches, 1.5);
  EXPECT_NE(to_table({{MethodName::kSift, "m", "q", keypoints}}).find("1.5 of 75 matches right"), std::string::npos);

  Answer roads;
  roads.rho_at_truth = 0.4;
  const std::vector<Outcome> outcomes = {judged("a", {}, roads, kUtm), judged("b", {}, Answer{}, kUtm)};
  EXPECT_EQ(summary_of(outcomes).median_rho_at_truth, 0.4);
  EXPECT_FALSE(summary_of(outcomes).mean_matches);
  EXPECT_NE(to_table({{MethodName::kRoads, "m", "q", outcomes}}).find("rho 0.40"), std::string::npos);
}

TEST(Summary, CountsNoTimeWhereNoPlaceWasLookedFor) {
  Answer asked;
  asked.time_ms = 80.0;
  const std::vector<Outcome> outcomes = {judged("a", {}, asked, kUtm), judged("b", {}, Answer{}, kUtm)};
  EXPECT_EQ(summary_of(outcomes).time_p50_ms, 80.0);
}

TEST(Summary, OfNothingHasNoMedian) {
  EXPECT_FALSE(summary_of({}).median_error_m);
  EXPECT_EQ(to_json({MethodName::kRoads, "m", "q", {}})["median_error_m"], nullptr);
}

TEST(Report, GivesTheEllipseThatEachNeesFollowsFrom) {
  FixMode mode;
  mode.pose.position = {37.76, 38.28};
  mode.ellipse.sigma_m = {4.0, 2.0};
  mode.ellipse.heading = Angle::degrees(90.0);
  mode.heading_sigma = Angle::degrees(0.5);
  Answer answer;
  answer.best = mode.pose;
  answer.mode = mode;
  const GeoPose truth{{37.76, 38.28009}, {}};  // about 8 m to the east
  const auto query = to_json({MethodName::kRoads, "m", "q", {judged("a", truth, answer, kUtm)}})["queries"][0];
  EXPECT_EQ(query["ellipse"]["sigma_m"], (std::vector<double>{4.0, 2.0}));
  EXPECT_NEAR(query["ellipse"]["heading_deg"].get<double>(), 90.0, 1e-9);
  EXPECT_NEAR(query["ellipse"]["heading_sigma_deg"].get<double>(), 0.5, 1e-9);
  const double error_m = query["error_m"];
  EXPECT_NEAR(query["position_nees"].get<double>(), error_m * error_m / 16.0, 0.01);
  EXPECT_EQ(to_json({MethodName::kSift, "m", "q", {judged("a", truth, {}, kUtm)}})["queries"][0]["ellipse"], nullptr);
}

TEST(Table, KeepsItsColumnsApartForLongNames) {
  const std::string table =
      to_table({{MethodName::kRoads, "liechtenstein-latest", "simulated 400x400 m, 60 % erased", {}},
                {MethodName::kSift, "town", "post.jpg 300x300 m", {}}});
  EXPECT_NE(table.find("liechtenstein-latest  simulated 400x400 m, 60 % erased    0"), std::string::npos) << table;
  EXPECT_NE(table.find("town                  post.jpg 300x300 m"), std::string::npos) << table;
}

TEST(QuerySet, IsDescribedWithTheErrorsOfItsFeatureMaps) {
  QuerySet set;
  set.kind = QuerySet::Kind::kSimulated;
  set.footprint = {300.0, 200.0};
  EXPECT_EQ(describe(set), "simulated 300x200 m");
  set.noise.low = set.noise.high = {.erase = 0.6, .shift_m = 4.0};
  EXPECT_EQ(describe(set), "simulated 300x200 m, 60 % erased, 4 m shifted");
  set.noise.low.erase = 0.0;
  EXPECT_EQ(describe(set), "simulated 300x200 m, 0 to 60 % erased, 4 m shifted");
}

TEST(QuerySet, IsDescribedWithAllThatTellsItFromOthersOverItsMap) {
  QuerySet set;
  set.map = set.from = "town";
  set.path = "after/post.jpg";
  set.footprint = {300.0, 200.0};
  set.prior_radius_m = 500.0;
  EXPECT_EQ(describe(set), "post.jpg 300x200 m, prior 500 m");
  set.prior_beyond_m = 30.0;
  EXPECT_EQ(describe(set), "post.jpg 300x200 m, prior 500 m wrong by 30 m");
  set.prior_heading_range = Angle::degrees(20.0);
  EXPECT_EQ(describe(set), "post.jpg 300x200 m, prior 500 m wrong by 30 m, heading within 20 deg");
  set.prior_heading_range.reset();
  set.kind = QuerySet::Kind::kFrames;
  set.prior_beyond_m.reset();
  set.elsewhere = true;
  set.together = 3;
  EXPECT_EQ(describe(set), "post.jpg elsewhere 3 together, prior 500 m");
  set.kind = QuerySet::Kind::kSimulated;
  set.together = 1;
  set.from = "newer";
  EXPECT_EQ(describe(set), "simulated from newer elsewhere 300x200 m, prior 500 m");
}

}  // namespace
}  // namespace roadfix::bench
