#include "core/locate/calibration.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kText = R"({"format": "roadfix-calibration-1", "bias": -3.0,
  "terms": {"surprise": {"weight": 0.5, "most": 8.0}, "lead": {"weight": 1.0, "most": 6.0},
            "gap": {"weight": 0.25, "most": 10.0}},
  "highest": 0.995, "sigma_scale": {"position": 1.1, "heading": 0.6}, "origin": {"maps": ["town"]}})";

TEST(Calibration, IsALogisticFunctionOfTheEvidence) {
  const Calibration calibration = parse_calibration(kText);
  EXPECT_NEAR(calibration.probability({1.0, 2.0, 4.0}), 1.0 / (1.0 + std::exp(3.0 - 0.5 - 2.0 - 1.0)), 1e-12);
  EXPECT_EQ(calibration.position_sigma_scale, 1.1);
  EXPECT_EQ(calibration.heading_sigma_scale, 0.6);
}

TEST(Calibration, IsNeverSurerThanItsExamples) {
  const Calibration calibration = parse_calibration(kText);
  EXPECT_EQ(calibration.probability({1e9, 1e9, 1e9}), 0.995);
  EXPECT_EQ(calibration.probability({1e9, 0.0, 0.0}), calibration.probability({8.0, 0.0, 0.0}));
}

TEST(Calibration, IsNotSureOfWhatChanceMayExplainWhateverTheExamplesSay) {
  const Calibration& calibration = default_calibration();
  EXPECT_EQ(calibration.probability({2.6, 100.0, 100.0}), std::exp(-std::exp(-2.6)));
  EXPECT_EQ(calibration.probability({1.0, 100.0, 100.0}), 0.9);
  EXPECT_GE(calibration.probability({5.0, 100.0, 100.0}), 0.99);
}

TEST(Calibration, RisesWithEveryFigure) {
  const Calibration& calibration = default_calibration();
  for (double surprise = -10.0; surprise < 20.0; surprise += 1.0) {
    for (double lead = 0.0; lead < 12.0; lead += 1.0) {
      const double here = calibration.probability({surprise, lead, lead});
      EXPECT_LE(here, calibration.probability({surprise + 1.0, lead, lead}));
      EXPECT_LE(here, calibration.probability({surprise, lead + 1.0, lead}));
      EXPECT_LE(here, calibration.probability({surprise, lead, lead + 1.0}));
    }
  }
}

TEST(Calibration, AsShippedReachesTheUsualConfidenceAndDoubtsWhatChanceExplains) {
  EXPECT_GE(default_calibration().probability({100.0, 100.0, 100.0}), 0.99);
  EXPECT_LT(default_calibration().probability({0.0, 0.5, 0.5}), 0.5);
}

TEST(Calibration, SaysWhichFieldOfAFileIsWrong) {
  const auto complain = [](const std::string& from, const std::string& to, const std::string& part) {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    EXPECT_THAT([&] { parse_calibration(text); }, ThrowsMessage<InvalidInput>(HasSubstr(part))) << text;
  };
  complain("calibration-1", "calibration-9", "format");
  complain("\"bias\": -3.0", "\"bias\": \"low\"", "bias");
  complain("\"weight\": 0.5", "\"weight\": -0.5", "weight");
  complain("\"lead\"", "\"load\"", "lead");
  complain("0.995", "1.0", "highest");
  complain("\"position\": 1.1, ", "", "position");
  complain("{\"format\"", "[\"format\"", "calibration file");
}

}  // namespace
}  // namespace roadfix
