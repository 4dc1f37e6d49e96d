// Are the answers as sure as they should be? Probabilities against what came true, ellipses against errors.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/bench/report.hpp"
#include "cli/evaluation/intervals.hpp"

namespace roadfix::bench {

/// Answers of similar probability.
struct ReliabilityBin {
  int n = 0;
  double mean_probability = 0.0;
  int right = 0;  ///< the truth lay within the region that the probability speaks of
};

/// What a user who asks for this confidence would have got.
struct AtConfidence {
  double confidence = 0.0;
  int answered = 0;
  int outside = 0;      ///< of those, the truth lay outside the region
  int false_fixes = 0;  ///< of those, further off than kFalseFixM
};

/// Errors against stated standard deviations, of answers of probability 0.9 or more that are no false fixes: what these
/// are, Honesty::at counts.
struct Consistency {
  int dimensions = 0;
  int n = 0;
  double mean_nees = 0.0;  ///< as many as dimensions if the standard deviations are right
  int within_95 = 0;       ///< of those answers, the truth lay within what is to hold 95 %
};

struct Honesty {
  int n = 0;                         ///< queries of which the answer has a probability
  std::vector<ReliabilityBin> bins;  ///< by rising probability, empty ones left out
  /// Mean distance between probability and share of right answers over the bins, weighed by their answers.
  double expected_calibration_error = 0.0;
  std::array<AtConfidence, 3> at;  ///< 0.9, 0.99, 0.999
  Consistency position{2};
  Consistency heading{1};
};

/// Outcomes without a mode (keypoint methods, nothing to search for) have no say.
Honesty honesty_of(std::span<const Outcome> outcomes);

nlohmann::json to_json(const Honesty& honesty);
std::string to_text(const Honesty& honesty);

}  // namespace roadfix::bench
