#include "cli/bench/honesty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/evaluation/nees.hpp"

namespace roadfix::bench {
namespace {

using evaluation::chi_square_mean_band;
using evaluation::clopper_pearson;
using evaluation::Interval;
using nlohmann::json;

constexpr std::array<double, 9> kBinEdges{0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.97, 0.99, 0.995};
constexpr double kConfident = 0.9;

bool false_fix(const Outcome& outcome) { return !outcome.error_m || *outcome.error_m > kFalseFixM; }

bool right(const Outcome& outcome) {
  return outcome.position_nees && *outcome.position_nees <= kRegionSigmas * kRegionSigmas;
}

std::vector<ReliabilityBin> bins_of(std::span<const Outcome> outcomes) {
  std::vector<ReliabilityBin> bins(kBinEdges.size() + 1);
  for (const Outcome& outcome : outcomes) {
    if (!outcome.answer.mode) continue;
    const double p = outcome.answer.probability;
    ReliabilityBin& bin = bins[static_cast<std::size_t>(std::ranges::upper_bound(kBinEdges, p) - kBinEdges.begin())];
    ++bin.n;
    bin.mean_probability += p;
    bin.right += right(outcome) ? 1 : 0;
  }
  std::erase_if(bins, [](const ReliabilityBin& bin) { return bin.n == 0; });
  for (ReliabilityBin& bin : bins) bin.mean_probability /= bin.n;
  return bins;
}

AtConfidence at_confidence(std::span<const Outcome> outcomes, double confidence) {
  AtConfidence at{confidence};
  for (const Outcome& outcome : outcomes) {
    if (!outcome.answer.mode || outcome.answer.probability < confidence) continue;
    ++at.answered;
    at.outside += right(outcome) ? 0 : 1;
    at.false_fixes += false_fix(outcome) ? 1 : 0;
  }
  return at;
}

void count(double nees, double chi_square_95, Consistency& consistency) {
  ++consistency.n;
  consistency.mean_nees += (nees - consistency.mean_nees) / consistency.n;
  consistency.within_95 += nees <= chi_square_95 ? 1 : 0;
}

json consistency_json(const Consistency& consistency) {
  json result = {{"n", consistency.n}};
  if (consistency.n == 0) return result;
  result["mean"] = consistency.mean_nees;
  result["band_95"] = evaluation::to_json(chi_square_mean_band(consistency.n, consistency.dimensions));
  result["within_95"] = consistency.within_95;
  result["within_95_share_95"] = evaluation::to_json(clopper_pearson(consistency.within_95, consistency.n));
  return result;
}

std::string consistency_text(const char* of, const Consistency& consistency, int left_out) {
  if (consistency.n == 0) return {};
  const Interval band = chi_square_mean_band(consistency.n, consistency.dimensions);
  return fmt::format("  {} NEES {:.2f} (consistent: {:.2f} to {:.2f}), {} of {} within their 95 %, {} false left out\n",
                     of, consistency.mean_nees, band.low, band.high, consistency.within_95, consistency.n, left_out);
}

}  // namespace

Honesty honesty_of(std::span<const Outcome> outcomes) {
  Honesty honesty;
  honesty.bins = bins_of(outcomes);
  for (const ReliabilityBin& bin : honesty.bins) {
    honesty.n += bin.n;
    honesty.expected_calibration_error += std::abs(bin.mean_probability * bin.n - bin.right);
  }
  if (honesty.n > 0) honesty.expected_calibration_error /= honesty.n;
  honesty.at = {at_confidence(outcomes, 0.9), at_confidence(outcomes, 0.99), at_confidence(outcomes, 0.999)};
  for (const Outcome& outcome : outcomes) {
    if (!outcome.position_nees || outcome.answer.probability < kConfident || false_fix(outcome)) continue;
    count(*outcome.position_nees, evaluation::kChiSquare95, honesty.position);
    if (outcome.heading_nees) count(*outcome.heading_nees, evaluation::kChiSquare95OfHeading, honesty.heading);
  }
  return honesty;
}

json to_json(const Honesty& honesty) {
  json bins = json::array();
  for (const ReliabilityBin& bin : honesty.bins) {
    bins.push_back({{"n", bin.n},
                    {"mean_probability", bin.mean_probability},
                    {"right", bin.right},
                    {"right_share_95", evaluation::to_json(clopper_pearson(bin.right, bin.n))}});
  }
  json at = json::array();
  for (const AtConfidence& a : honesty.at) {
    at.push_back({{"confidence", a.confidence},
                  {"answered", a.answered},
                  {"outside_ellipse", a.outside},
                  {"false_fixes", a.false_fixes},
                  {"false_fix_rate_95", evaluation::to_json(clopper_pearson(a.false_fixes, a.answered))}});
  }
  return {{"n", honesty.n},
          {"reliability", bins},
          {"expected_calibration_error", honesty.expected_calibration_error},
          {"at_confidence", at},
          {"position_nees", consistency_json(honesty.position)},
          {"heading_nees", consistency_json(honesty.heading)}};
}

std::string to_text(const Honesty& honesty) {
  if (honesty.n == 0) return {};
  std::string text = fmt::format("honesty over {} answers: expected calibration error {:.3f}\n", honesty.n,
                                 honesty.expected_calibration_error);
  for (const ReliabilityBin& bin : honesty.bins) {
    const Interval share = clopper_pearson(bin.right, bin.n);
    text += fmt::format("  said {:.3f}: right {:>4} of {:<4} = {:.3f} (95 %: {:.3f} to {:.3f})\n", bin.mean_probability,
                        bin.right, bin.n, static_cast<double>(bin.right) / bin.n, share.low, share.high);
  }
  for (const AtConfidence& a : honesty.at) {
    const Interval rate = clopper_pearson(a.false_fixes, a.answered);
    text += fmt::format("  at confidence {}: {} fixes, {} false (95 %: {:.4f} to {:.4f}), {} outside their ellipse\n",
                        a.confidence, a.answered, a.false_fixes, rate.low, rate.high, a.outside);
  }
  const int left_out = honesty.at[0].false_fixes;
  return text + consistency_text("position", honesty.position, left_out) +
         consistency_text("heading", honesty.heading, left_out);
}

}  // namespace roadfix::bench
