#include "core/locate/calibration.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kText = R"({"format": "roadfix-calibration-2", "bias": -3.0,
  "terms": {"surprise": {"weight": 0.5, "most": 8.0}, "lead": {"weight": 1.0, "most": 6.0},
            "gap": {"weight": 0.25, "most": 10.0}, "ground": {"weight": 2.0, "most": 11.0}},
  "highest": 0.995, "sigma_scale": {"position": 1.1, "heading": 0.6}, "origin": {"maps": ["town"]}})";

SearchFigures figures(double surprise, double lead, double gap, double ground = 100.0) {
  return {.surprise = surprise, .lead = lead, .gap = gap, .ground = ground, .other_roads_across = 2.0};
}

TEST(Calibration, IsALogisticFunctionOfTheFigures) {
  const Calibration calibration = parse_calibration(kText);
  EXPECT_NEAR(calibration.probability(figures(1.0, 2.0, 4.0, 0.1)), 1.0 / (1.0 + std::exp(3.0 - 0.5 - 2.0 - 1.0 - 0.2)),
              1e-12);
  EXPECT_EQ(calibration.position_sigma_scale, 1.1);
  EXPECT_EQ(calibration.heading_sigma_scale, 0.6);
}

TEST(Calibration, IsNeverSurerThanItsExamples) {
  const Calibration calibration = parse_calibration(kText);
  EXPECT_EQ(calibration.probability(figures(1e9, 1e9, 1e9)), 0.995);
  EXPECT_EQ(calibration.probability(figures(1e9, 0.0, 0.0, 0.0)), calibration.probability(figures(8.0, 0.0, 0.0, 0.0)));
}

TEST(Calibration, IsNotSureOfWhatChanceMayExplainWhateverTheExamplesSay) {
  const Calibration& calibration = *shipped_calibration();
  EXPECT_EQ(calibration.probability(figures(2.6, 100.0, 100.0)), std::exp(-std::exp(-2.6)));
  EXPECT_EQ(calibration.probability(figures(0.0, 100.0, 100.0)), 0.5);
  EXPECT_GE(calibration.probability(figures(5.0, 100.0, 100.0)), 0.99);
}

TEST(Calibration, IsNotSureOfAPlaceThatRestsOnNoMoreThanOneStraightRoad) {
  SearchFigures far_ahead = figures(100.0, 100.0, 100.0);
  far_ahead.other_roads_across = 0.39;
  EXPECT_EQ(shipped_calibration()->probability(far_ahead), 0.5);
  far_ahead.other_roads_across = 0.41;
  EXPECT_GE(shipped_calibration()->probability(far_ahead), 0.99);
}

TEST(Calibration, TrustsNoFigureThatIsNoNumber) {
  for (const CountedFigure& figure : kCountedFigures) {
    SearchFigures broken = figures(100.0, 100.0, 100.0);
    broken.*figure.value = std::nan("");
    EXPECT_EQ(shipped_calibration()->probability(broken), 0.0) << figure.name;
  }
  SearchFigures broken = figures(100.0, 100.0, 100.0);
  broken.other_roads_across = std::nan("");
  EXPECT_LE(shipped_calibration()->probability(broken), 0.5);
}

TEST(Calibration, RisesWithEveryFigure) {
  const Calibration& calibration = *shipped_calibration();
  for (double surprise = -10.0; surprise < 20.0; surprise += 1.0) {
    for (double lead = 0.0; lead < 12.0; lead += 1.0) {
      const double here = calibration.probability(figures(surprise, lead, lead, 10.0));
      EXPECT_LE(here, calibration.probability(figures(surprise + 1.0, lead, lead, 10.0)));
      EXPECT_LE(here, calibration.probability(figures(surprise, lead + 1.0, lead, 10.0)));
      EXPECT_LE(here, calibration.probability(figures(surprise, lead, lead + 1.0, 10.0)));
      EXPECT_LE(here, calibration.probability(figures(surprise, lead, lead, 10.5)));
    }
  }
}

TEST(Calibration, AsShippedDoubtsSmallFootprintsMoreThanLargeOnes) {
  const auto of_footprint = [](double side_m) { return figures(3.0, 2.0, 2.0, std::log(side_m * side_m)); };
  const Calibration& calibration = *shipped_calibration();
  EXPECT_LT(calibration.probability(of_footprint(70.0)) + 0.1, calibration.probability(of_footprint(300.0)));
}

TEST(Calibration, AsShippedReachesTheUsualConfidenceAndDoubtsWhatChanceExplains) {
  EXPECT_GE(shipped_calibration()->probability(figures(100.0, 100.0, 100.0)), 0.99);
  EXPECT_LT(shipped_calibration()->probability(figures(0.0, 0.5, 0.5)), 0.5);
}

TEST(Calibration, SaysWhichFieldOfAFileIsWrong) {
  const auto complain = [](const std::string& from, const std::string& to, const std::string& part) {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    EXPECT_THAT([&] { parse_calibration(text); }, ThrowsMessage<InvalidInput>(HasSubstr(part))) << text;
  };
  complain("calibration-2", "calibration-1", "format");
  complain("\"bias\": -3.0", "\"bias\": \"low\"", "bias");
  complain("\"weight\": 0.5", "\"weight\": -0.5", "weight");
  complain("\"lead\"", "\"load\"", "lead");
  complain("0.995", "1.0", "highest");
  complain("\"position\": 1.1, ", "", "position");
  complain("-3.0", "-3e999", "number overflow");
  complain("{\"maps\": [\"town\"]}", "\"town\"", "origin must be an object");
  complain("\"bias\": -3.0", "\"bias\": 2.0, \"bias\": -3.0", "'bias' is given twice");
  complain("\"most\": 8.0", "\"most\": 8.0, \"most\": 9.0", "'most' is given twice");
  complain("{\"format\"", "[\"format\"", "calibration file: byte 10 is no JSON");
}

}  // namespace
}  // namespace roadfix
