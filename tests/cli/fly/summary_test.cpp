#include "cli/fly/summary.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/fly/flight_files.hpp"

namespace roadfix::fly {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

/// Steps of 1 s with these errors, all with a frame; claimed where the error is written as negative.
Run run_with(const std::vector<double>& errors) {
  Run run;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    Record record;
    record.sequence = static_cast<std::int64_t>(i);
    record.time_s = static_cast<double>(i);
    record.saw = true;
    record.error_m = std::abs(errors[i]);
    record.nees = 2.0;
    record.truth = record.best = {{500'000.0, 6'400'000.0}, {}};
    if (errors[i] < 0.0) record.estimate.unclaimed.reset();
    record.estimate.clusters = {{{{57.0, 21.0}, {}}, 0.95, {{4.0, 2.0}, {}}, {}, 10.0}};
    record.estimate.particles = 100;
    run.records.push_back(record);
  }
  return run;
}

std::vector<double> many(std::size_t count, double error) { return std::vector<double>(count, error); }

std::vector<double> joined(std::vector<double> first, const std::vector<double>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST(FlightSummary, AVehicleIsFoundOnceTheEstimateStaysAtIt) {
  EXPECT_THAT(found_at(run_with(joined(many(3, 400.0), many(20, 5.0))).records), Optional(3u));
  EXPECT_EQ(found_at(run_with(joined(many(9, 5.0), many(20, 400.0))).records), std::nullopt) << "nine steps are chance";
  EXPECT_THAT(found_at(run_with(joined(many(9, 400.0), many(2, 5.0))).records), Optional(9u)) << "to the end counts";
  EXPECT_THAT(found_at(run_with(many(30, 5.0)).records, 12), Optional(12u));
}

TEST(FlightSummary, CountsRunsFoundLostAndWronglyConverged) {
  const std::vector<fly::Run> runs{run_with(joined(many(4, 400.0), many(16, -5.0))), run_with(many(20, 300.0)),
                                   run_with(joined(many(10, 5.0), many(10, -100.0)))};
  const Summary s = summary_of(runs, {});
  EXPECT_EQ(s.runs, 3);
  EXPECT_EQ(s.found, 2);
  EXPECT_EQ(s.wrong_at_end, 2);
  EXPECT_EQ(s.claimed_runs, 2);
  EXPECT_EQ(s.first_claim_false, 1);
  EXPECT_EQ(s.claims, 26);
  EXPECT_EQ(s.false_claims, 10);
  EXPECT_THAT(s.updates_median, Optional(3.0));  // of 5 and 1
  EXPECT_THAT(s.nees_mean, Optional(2.0));
  EXPECT_THAT(s.within_95, Optional(1.0));
  EXPECT_THAT(to_table(std::vector<std::pair<std::string, Summary>>{{"paper", s}}, {}), HasSubstr("paper"));
  EXPECT_EQ(to_json(s)["claims"]["false_steps"], 10);
}

TEST(FlightSummary, TellsHowFarSharesOfFewRunsCanBeTrusted) {
  Summary s;
  s.runs = 20;
  s.found = 20;
  s.claimed_runs = 10;
  s.first_claim_false = 5;
  const nlohmann::json told = to_json(s);
  // Brown, Cai, DasGupta 2001.
  EXPECT_NEAR(told["found_share_95"][0], 1.0 - 0.16843, 1e-5);
  EXPECT_EQ(told["found_share_95"][1], 1.0);
  EXPECT_NEAR(told["claims"]["runs_share_95"][0], 0.27196, 1e-5);
  EXPECT_NEAR(told["claims"]["first_false_share_95"][1], 0.81291, 1e-5);
  EXPECT_NEAR(told["recovered_share_95"][1], 0.16843, 1e-5);
}

TEST(FlightSummary, KeepsItsColumnsApartWhereClaimsAreKilometresOff) {
  Summary s;
  s.claims = s.false_claims = 22;
  s.nees_mean = 22522178.4;
  EXPECT_THAT(to_table(std::vector<std::pair<std::string, Summary>>{{"paper", s}}, {}), HasSubstr("22/22  22522178.4"));
}

TEST(FlightSummary, KeepsItsColumnsApartWhereABusyServiceTakesSecondsAStep) {
  Summary s;
  s.within_95 = 1.0;
  s.step_ms_median = 2135.8;
  s.step_ms_p95 = 23614.7;
  EXPECT_THAT(to_table(std::vector<std::pair<std::string, Summary>>{{"default", s}}, {}),
              HasSubstr(" 1.00 2135.8 (23614.7)"));
}

TEST(FlightSummary, TellsHowLongAKidnappingWentUnnoticedAndUntilTheVehicleWasFoundAgain) {
  const std::vector<double> errors =
      joined(joined(many(20, -5.0), many(3, -2000.0)), joined(many(7, 2000.0), many(20, -5.0)));
  const Events events{Kidnapping{20, 2000.0}, {}};
  const Summary s = summary_of(std::vector<fly::Run>{run_with(errors)}, events);
  EXPECT_EQ(s.recovered, 1);
  EXPECT_THAT(s.withdrawal_s_median, Optional(3.0));
  EXPECT_THAT(s.recovery_s_median, Optional(10.0));
  EXPECT_EQ(s.found, 1) << "before the kidnapping";
  EXPECT_THAT(to_table(std::vector<std::pair<std::string, Summary>>{{"default", s}}, events),
              HasSubstr("1 of 1 found again, after 10 s"));
}

TEST(FlightSummary, JudgesTheEndOfAFlightAfterAKidnappingToo) {
  const Events events{Kidnapping{20, 2000.0}, {}};
  const Summary s = summary_of(std::vector<fly::Run>{run_with(joined(many(20, 5.0), many(20, -2000.0)))}, events);
  EXPECT_EQ(s.found, 1);
  EXPECT_THAT(s.error_median_m, Optional(5.0)) << "of the search";
  EXPECT_EQ(s.wrong_at_end, 1);
  EXPECT_THAT(s.final_error_median_m, Optional(2000.0));
}

TEST(FlightFiles, GiveALineForEachStepAndTheEllipseOfEachClaim) {
  const UtmZone zone = UtmZone::from_epsg(32634).value();
  const fly::Run run = run_with({300.0, -5.0, -5.0});
  const std::string lines = csv_lines("default", run, zone);
  EXPECT_EQ(std::ranges::count(lines, '\n'), 3);
  const std::string header = csv_header();
  EXPECT_EQ(std::ranges::count(lines, ','), 3 * std::ranges::count(header, ','));
  const auto features = geojson_features("default", run, zone);
  ASSERT_EQ(features.size(), 4u);  // two ellipses, the true path, the estimated path
  EXPECT_EQ(features[0]["geometry"]["type"], "Polygon");
  EXPECT_EQ(features[0]["geometry"]["coordinates"][0].size(), 37u);
  EXPECT_EQ(features[2]["geometry"]["coordinates"].size(), 3u);
  EXPECT_EQ(features[3]["geometry"]["coordinates"].size(), 2u);
}

TEST(FlightFiles, CutWhatLiesOnBothSidesOf180Degrees) {
  const UtmZone zone = UtmZone::from_epsg(32760).value();
  fly::Run run = run_with({-5.0, -5.0});
  run.records[0].truth = run.records[0].best = {zone.project({-17.0, 179.999}), {}};
  run.records[1].truth = run.records[1].best = {zone.project({-17.0, 180.0}), {}};
  run.records[1].truth.position.east_m += 100.0;
  const auto features = geojson_features("default", run, zone);
  ASSERT_EQ(features.size(), 4u);
  EXPECT_EQ(features[0]["geometry"]["type"], "Polygon");
  EXPECT_EQ(features[1]["geometry"]["type"], "MultiPolygon");
  EXPECT_EQ(features[2]["geometry"]["type"], "MultiLineString");
}

TEST(FlightFiles, GiveTheCovarianceToTrueEastAndNorthAsTheEllipse) {
  const UtmZone zone = UtmZone::from_epsg(32634).value();
  fly::Run run = run_with({-5.0});
  // Grid north is 1.4 degrees off true north here.
  run.records[0].truth = run.records[0].best = {{600'000.0, 6'400'000.0}, {}};
  EXPECT_THAT(csv_lines("default", run, zone), HasSubstr(",4.000,2.000,0.00,0.000,4.0000,0.0000,16.0000,"));
}

}  // namespace
}  // namespace roadfix::fly
