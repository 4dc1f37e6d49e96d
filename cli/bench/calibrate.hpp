// Learns a calibration from answered queries with known truth.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/bench/report.hpp"
#include "core/locate/calibration.hpp"

namespace roadfix::bench {

struct CalibrationReport {
  Calibration calibration;
  int examples = 0;
  int right = 0;
  int elsewhere = 0;
  std::vector<std::string> kept;  ///< "positions", "headings": whose sigma scale is as before, for want of answers
};

/// Sigma scales first, from the normalised errors of the answers within 25 m whose frames do not tell more than half of
/// the stated deviation themselves, if there are 50; then, with the regions that follow, a logistic regression with
/// weights >= 0 and a small ridge; then the highest probability that the examples vouch for by Laplace's rule. The
/// outcomes must come from `in_force`, whose scales are undone. Throws InvalidInput "calibration-too-few-examples"
/// below 50 right or 50 wrong answers.
CalibrationReport learn_calibration(std::span<const Outcome> outcomes, const Calibration& in_force);

/// The file's content; `origin` says where it was learned.
nlohmann::json calibration_json(const CalibrationReport& report, const nlohmann::json& origin);

/// What has to be said of a calibration that would give no fix, or state places far more accurate than maps are.
std::vector<std::string> notes_on(const CalibrationReport& report);

struct HeadingScale {
  double scale = 1.0;
  int right = 0;  ///< answers that it was learned from
};

/// The sigma scale of headings alone, as learn_calibration() learns it. Throws likewise below 50 answers to learn from.
HeadingScale learn_heading_scale(std::span<const Outcome> outcomes, const Calibration& in_force);

/// The content of a calibration file with that scale instead of its own. Throws as parse_calibration() does.
nlohmann::json with_heading_scale(std::string_view calibration, const HeadingScale& learned,
                                  const nlohmann::json& origin);

}  // namespace roadfix::bench
