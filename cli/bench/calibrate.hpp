// Learns a calibration from answered queries with known truth.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "cli/bench/report.hpp"
#include "core/locate/calibration.hpp"

namespace roadfix::bench {

struct CalibrationReport {
  Calibration calibration;
  int examples = 0;
  int right = 0;
  int elsewhere = 0;
};

/// Sigma scales first, from the normalised errors of the right answers; then, with the regions that follow, a logistic
/// regression with weights >= 0 and a small ridge; then the highest probability that the examples vouch for by
/// Laplace's rule. The outcomes must come from `in_force`, whose scales are undone. Throws InvalidInput
/// "calibration-too-few-examples" below 50 right or 50 wrong answers.
CalibrationReport learn_calibration(std::span<const Outcome> outcomes, const Calibration& in_force);

/// The file's content; `origin` says where it was learned.
nlohmann::json calibration_json(const CalibrationReport& report, const nlohmann::json& origin);

}  // namespace roadfix::bench
