#include "cli/bench/calibrate.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/evaluation/random.hpp"
#include "core/units/draws.hpp"
#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Answers that are right with a probability that is a logistic function of the surprise, errors of twice the ellipse.
std::vector<Outcome> drawn(int n, std::uint64_t seed) {
  evaluation::Random random = evaluation::stream(seed, 0, 0);
  std::vector<Outcome> outcomes;
  for (int i = 0; i < n; ++i) {
    Outcome outcome;
    const double surprise = uniform(random, -5.0, 5.0);
    outcome.answer.figures = SearchFigures{surprise, 0.0, 0.0};
    outcome.answer.mode = FixMode{};
    outcome.answer.mode->heading_sigma = Angle::degrees(1.0);
    const bool right = uniform(random, 0.0, 1.0) < 1.0 / (1.0 + std::exp(-1.5 * surprise));
    // Chi^2 of two degrees, times 4: ellipses half as large as they should be.
    const double nees = -8.0 * std::log(1.0 - uniform(random, 0.0, 1.0));
    outcome.truth = GeoPose{};
    outcome.error_m = right ? 2.0 : 500.0;
    outcome.heading_nees = 0.25;
    outcome.position_nees = right ? nees : 1e6;
    outcomes.push_back(outcome);
  }
  return outcomes;
}

TEST(LearnCalibration, FindsTheLogisticFunctionBelowTheMedianOfTheRight) {
  const CalibrationReport report = learn_calibration(drawn(4000, 1), *shipped_calibration());
  // Above one half the chance that other places fit bounds it.
  for (const double surprise : {-2.0, -1.0, -0.5, 0.0}) {
    // The spread of a logistic regression on 4000 examples is about 0.02 here; the cut-off bends it a little.
    EXPECT_NEAR(report.calibration.probability({surprise, 0.0, 0.0}), 1.0 / (1.0 + std::exp(-1.5 * surprise)), 0.06);
  }
  EXPECT_EQ(report.examples, 4000);
}

TEST(LearnCalibration, WidensEllipsesThatAreTooSmall) {
  const Calibration& before = *shipped_calibration();
  // Of the 1000 that are right the scale has a spread of 1.6 %.
  const CalibrationReport report = learn_calibration(drawn(2000, 2), before);
  EXPECT_NEAR(report.calibration.position_sigma_scale / before.position_sigma_scale, 2.0, 0.1);
}

TEST(LearnCalibration, ClaimsNoMoreThanTheExamplesVouchFor) {
  const CalibrationReport report = learn_calibration(drawn(400, 3), *shipped_calibration());
  EXPECT_LT(report.calibration.highest, 1.0 - 1.0 / 402.0);
  const SearchFigures surest{.surprise = 100.0, .lead = 100.0, .gap = 100.0, .other_roads_across = 2.0};
  EXPECT_GT(report.calibration.probability(surest), 0.9);
  EXPECT_LE(report.calibration.probability(surest), report.calibration.highest);
}

TEST(LearnCalibration, CountsTheWrongAmongAnswersThatAreAllAsSure) {
  std::vector<Outcome> outcomes = drawn(200, 10);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const bool sure = i < 120;  // the 100 right ones and 20 wrong ones; all count as the median of the right
    const bool right = i < 100;
    outcomes[i].answer.figures = SearchFigures{sure ? 5.0 : -5.0, 0.0, 0.0};
    outcomes[i].error_m = right ? 2.0 : 500.0;
    outcomes[i].position_nees = right ? 1.0 : 1e6;
  }
  EXPECT_DOUBLE_EQ(learn_calibration(outcomes, *shipped_calibration()).calibration.highest, 1.0 - 21.0 / 122.0);
}

TEST(LearnCalibration, RefusesTooFewExamples) {
  EXPECT_THROW(learn_calibration(drawn(60, 4), *shipped_calibration()), InvalidInput);
}

TEST(LearnCalibration, WritesWhatTheServiceReads) {
  const CalibrationReport report = learn_calibration(drawn(1000, 5), *shipped_calibration());
  const Calibration read = parse_calibration(calibration_json(report, {{"seed", 5}}).dump());
  for (const double surprise : {-3.0, 0.0, 4.0}) {
    const SearchFigures figures{.surprise = surprise, .lead = 1.0, .gap = 1.0, .other_roads_across = 2.0};
    EXPECT_EQ(read.probability(figures), report.calibration.probability(figures));
  }
  EXPECT_EQ(read.highest, report.calibration.highest);
  EXPECT_EQ(read.position_sigma_scale, report.calibration.position_sigma_scale);
  EXPECT_EQ(read.heading_sigma_scale, report.calibration.heading_sigma_scale);
  EXPECT_EQ(calibration_json(report, {{"seed", 5}})["origin"]["examples"], 1000);
}

TEST(LearnCalibration, WritesWhatTheServiceReadsHoweverSmallTheErrors) {
  std::vector<Outcome> exact = drawn(1000, 6);
  for (Outcome& outcome : exact) {
    outcome.position_nees = *outcome.position_nees < 1e6 ? 1e-6 * *outcome.position_nees : 1e6;
    outcome.heading_nees = 1e-6;
  }
  const CalibrationReport report = learn_calibration(exact, *shipped_calibration());
  EXPECT_EQ(parse_calibration(calibration_json(report, nlohmann::json::object()).dump()).position_sigma_scale, 0.1);
}

TEST(LearnCalibration, LearnsNothingOfMapsFromFramesThatAreMoreUncertainThemselves) {
  const Calibration& before = *shipped_calibration();
  std::vector<Outcome> cautious = drawn(1000, 11);
  for (Outcome& outcome : cautious) {
    outcome.answer.mode->ellipse.sigma_m = {7.0, 6.0};
    outcome.answer.nadir_sigma_m = 5.0;
    outcome.answer.nadir_heading_sigma = Angle::degrees(0.9);
    if (*outcome.error_m < 25.0) outcome.position_nees = 0.01 * *outcome.position_nees;
  }
  const CalibrationReport report = learn_calibration(cautious, before);
  EXPECT_EQ(report.calibration.position_sigma_scale, before.position_sigma_scale);
  EXPECT_EQ(report.calibration.heading_sigma_scale, before.heading_sigma_scale);
  EXPECT_THAT(notes_on(report), Contains(HasSubstr("the accuracy of positions and headings stays as it was")));
  EXPECT_THROW(learn_heading_scale(cautious, before), InvalidInput);
}

TEST(LearnCalibration, CountsAsRightWhatLiesInTheEllipseThatWillBeStated) {
  std::vector<Outcome> outcomes = drawn(2000, 12);  // wants ellipses twice as large
  std::vector<Outcome> of_cameras = drawn(400, 13);
  for (Outcome& outcome : of_cameras) {
    outcome.answer.mode->ellipse.sigma_m = {20.0, 20.0};
    outcome.answer.nadir_sigma_m = 19.0;
    outcome.error_m = 100.0;
    outcome.position_nees = 30.0;  // beyond four deviations, of which cameras tell nearly all
  }
  const int right = learn_calibration(outcomes, *shipped_calibration()).right;
  outcomes.insert(outcomes.end(), of_cameras.begin(), of_cameras.end());
  EXPECT_EQ(learn_calibration(outcomes, *shipped_calibration()).right, right);
}

TEST(LearnCalibration, SaysWhereItsPlacesWouldBeStatedMoreAccurateThanTheyAre) {
  CalibrationReport report;
  report.calibration = *shipped_calibration();
  EXPECT_THAT(notes_on(report), IsEmpty());
  report.calibration.position_sigma_scale = 0.25;
  report.calibration.heading_sigma_scale = 0.125;
  EXPECT_THAT(notes_on(report), ElementsAre(HasSubstr("4.0 times nearer"), HasSubstr("8.0 times nearer")));
}

TEST(LearnCalibration, SaysWhereItsExamplesVouchForNoFix) {
  CalibrationReport report = learn_calibration(drawn(110, 14), *shipped_calibration());
  ASSERT_LT(report.calibration.highest, 0.99);
  report.calibration.heading_sigma_scale = 1.0;
  EXPECT_THAT(notes_on(report), ElementsAre(HasSubstr("with this calibration there is none")));
}

TEST(LearnHeadingScale, WidensHeadingsThatAreSurerThanTheyShouldBe) {
  const Calibration& before = *shipped_calibration();
  std::vector<Outcome> outcomes = drawn(400, 7);
  for (Outcome& outcome : outcomes) outcome.heading_nees = 9.0;  // three standard deviations off
  // A mean of 1 asks for a factor of 3, the 95th percentile of chi^2 (3.84) for less.
  EXPECT_NEAR(learn_heading_scale(outcomes, before).scale / before.heading_sigma_scale, 3.0, 1e-9);
}

TEST(LearnHeadingScale, LearnsFromNoPlaceThatIsWrong) {
  std::vector<Outcome> outcomes = drawn(400, 8);
  int right = 0;
  for (Outcome& outcome : outcomes) {
    if (*outcome.error_m > 25.0) {
      outcome.heading_nees = 1e6;
    } else {
      ++right;
    }
  }
  const HeadingScale learned = learn_heading_scale(outcomes, *shipped_calibration());
  EXPECT_EQ(learned.right, right);
  EXPECT_LT(learned.scale, shipped_calibration()->heading_sigma_scale);  // 0.25 each
  EXPECT_THROW(learn_heading_scale(std::span(outcomes).first(50), *shipped_calibration()), InvalidInput);
}

TEST(LearnHeadingScale, ChangesNothingElseOfACalibration) {
  const CalibrationReport report = learn_calibration(drawn(1000, 9), *shipped_calibration());
  const nlohmann::json before = calibration_json(report, {{"seed", 9}});
  nlohmann::json after = with_heading_scale(before.dump(), {1.75, 60}, {{"seed", 10}});
  EXPECT_EQ(parse_calibration(after.dump()).heading_sigma_scale, 1.75);
  EXPECT_EQ(after["origin"]["heading"], nlohmann::json({{"seed", 10}, {"right", 60}}));
  after["sigma_scale"]["heading"] = before["sigma_scale"]["heading"];
  after["origin"].erase("heading");
  EXPECT_EQ(after, before);
  EXPECT_THROW(with_heading_scale("{}", {1.75, 60}, {}), InvalidInput);
}

}  // namespace
}  // namespace roadfix::bench
