#include "cli/bench/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/evaluation/nees.hpp"
#include "cli/evaluation/statistics.hpp"
#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

using evaluation::quantile;
using nlohmann::json;

constexpr std::size_t kFigures = kCountedFigures.size();
constexpr std::size_t kFewest = 50;
// What parse_calibration() takes. Errors far below what the peak tells are those of simulated frames without a shift.
constexpr double kSmallestScale = 0.1;
constexpr double kLargestScale = 100.0;

struct Example {
  std::array<double, kFigures> figures{};
  bool right = false;
};

/// So that the right answers have the mean of chi^2, and 95 % of them lie where 95 % should.
double scale_of(const std::vector<double>& normalised, double mean, double within_95) {
  if (normalised.size() < kFewest) return 1.0;
  double sum = 0.0;
  for (const double value : normalised) sum += value / static_cast<double>(normalised.size());
  return std::sqrt(std::max(sum / mean, quantile(normalised, 0.95).value_or(0.0) / within_95));
}

/// NEES of the right answers.
struct NormalisedErrors {
  std::vector<double> position;
  std::vector<double> heading;
};

/// Of a frame that says itself how uncertain it is, the answer errs by its camera more than by the match and the map:
/// it would scale these by how cautious the frame is.
bool tells_most(double told, double stated) { return told > 0.5 * stated; }

NormalisedErrors normalised_errors(std::span<const Outcome> outcomes) {
  NormalisedErrors errors;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.position_nees || !outcome.error_m || *outcome.error_m > kFalseFixM) continue;
    const Answer& answer = outcome.answer;
    if (!tells_most(answer.nadir_sigma_m, answer.mode->ellipse.sigma_m[1])) {
      errors.position.push_back(*outcome.position_nees);
    }
    if (!tells_most(answer.nadir_heading_sigma.radians(), answer.mode->heading_sigma.radians())) {
      errors.heading.push_back(*outcome.heading_nees);
    }
  }
  return errors;
}

/// How much larger the ellipse of an answer becomes where the part of it that calibrations scale grows by `factor`; of
/// its axes the lesser.
double growth(const Answer& answer, double factor) {
  const auto of_axis = [&](double sigma_m) {
    const double told = sigma_m > 0.0 ? std::min(answer.nadir_sigma_m / sigma_m, 1.0) : 0.0;
    return std::sqrt(factor * factor * (1.0 - told * told) + told * told);
  };
  const auto& sigma_m = answer.mode->ellipse.sigma_m;
  return std::min(of_axis(sigma_m[0]), of_axis(sigma_m[1]));
}

double bounded(double scale) { return std::clamp(scale, kSmallestScale, kLargestScale); }

double position_scale(const NormalisedErrors& errors, const Calibration& in_force) {
  return bounded(in_force.position_sigma_scale * scale_of(errors.position, 2.0, evaluation::kChiSquare95));
}

double heading_scale(const NormalisedErrors& errors, const Calibration& in_force) {
  return bounded(in_force.heading_sigma_scale * scale_of(errors.heading, 1.0, evaluation::kChiSquare95OfHeading));
}

/// Bias first.
using Weights = std::array<double, kFigures + 1>;

double sum_of(const Weights& weights, const std::array<double, kFigures>& figures) {
  double sum = weights[0];
  for (std::size_t i = 0; i < kFigures; ++i) sum += weights[i + 1] * figures[i];
  return sum;
}

/// Maximum likelihood with a ridge over standardised figures, by projected gradient ascent: the problem is convex.
Weights logistic(std::span<const Example> examples) {
  constexpr int kSteps = 20'000;
  constexpr double kRidge = 1e-3;
  constexpr double kRate = 0.5;
  Weights weights{};
  const auto n = static_cast<double>(examples.size());
  for (int step = 0; step < kSteps; ++step) {
    Weights gradient{};
    for (const Example& example : examples) {
      const double miss = (example.right ? 1.0 : 0.0) - 1.0 / (1.0 + std::exp(-sum_of(weights, example.figures)));
      gradient[0] += miss / n;
      for (std::size_t i = 0; i < kFigures; ++i) gradient[i + 1] += miss * example.figures[i] / n;
    }
    weights[0] += kRate * gradient[0];
    for (std::size_t i = 1; i <= kFigures; ++i) {
      weights[i] = std::max(0.0, weights[i] + kRate * (gradient[i] - kRidge * weights[i]));
    }
  }
  return weights;
}

/// The largest probability of a group of surest answers, by Laplace's rule of succession. Answers that are as sure as
/// each other belong to the same groups.
double highest_of(std::span<const Example> examples, const Weights& weights) {
  std::vector<std::pair<double, bool>> surest;
  for (const Example& example : examples) surest.emplace_back(sum_of(weights, example.figures), example.right);
  std::ranges::sort(surest, std::ranges::greater{});
  double highest = 0.0;
  int wrong = 0;
  for (std::size_t i = 0; i < surest.size(); ++i) {
    wrong += surest[i].second ? 0 : 1;
    if (i + 1 < surest.size() && surest[i + 1].first == surest[i].first) continue;
    highest = std::max(highest, 1.0 - (wrong + 1.0) / (static_cast<double>(i) + 3.0));
  }
  return highest;
}

struct Scaling {
  std::array<double, kFigures> max{};
  std::array<double, kFigures> mean{};
  std::array<double, kFigures> spread{};
};

/// Cuts the figures off at the median of the right answers, above which hardly a wrong one is left to learn from, then
/// brings them to mean 0 and spread 1.
Scaling standardise(std::vector<Example>& examples) {
  Scaling scaling;
  const auto n = static_cast<double>(examples.size());
  for (std::size_t i = 0; i < kFigures; ++i) {
    std::vector<double> values;
    for (const Example& example : examples) {
      if (example.right) values.push_back(example.figures[i]);
    }
    scaling.max[i] = quantile(values, 0.5).value_or(0.0);
    for (Example& example : examples) example.figures[i] = std::min(example.figures[i], scaling.max[i]);
    for (const Example& example : examples) scaling.mean[i] += example.figures[i] / n;
    double square = 0.0;
    for (const Example& example : examples) square += std::pow(example.figures[i] - scaling.mean[i], 2) / n;
    scaling.spread[i] = std::max(std::sqrt(square), 1e-9);
    for (Example& example : examples) example.figures[i] = (example.figures[i] - scaling.mean[i]) / scaling.spread[i];
  }
  return scaling;
}

}  // namespace

CalibrationReport learn_calibration(std::span<const Outcome> outcomes, const Calibration& in_force) {
  CalibrationReport report;
  const NormalisedErrors errors = normalised_errors(outcomes);
  const double sigma_scale = position_scale(errors, in_force);
  const double factor = sigma_scale / in_force.position_sigma_scale;
  std::vector<Example> examples;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.answer.figures || !outcome.position_nees) continue;
    Example& example = examples.emplace_back();
    for (std::size_t i = 0; i < kFigures; ++i) {
      example.figures[i] = (*outcome.answer.figures).*kCountedFigures[i].value;
    }
    example.right = *outcome.position_nees <= std::pow(kRegionSigmas * growth(outcome.answer, factor), 2);
    report.right += example.right ? 1 : 0;
    report.elsewhere += outcome.truth ? 0 : 1;
  }
  report.examples = static_cast<int>(examples.size());
  if (errors.position.size() < kFewest) report.kept.emplace_back("positions");
  if (errors.heading.size() < kFewest) report.kept.emplace_back("headings");
  const auto right = static_cast<std::size_t>(report.right);
  if (right < kFewest || examples.size() - right < kFewest) {
    throw InvalidInput("calibration-too-few-examples",
                       fmt::format("{} right and {} wrong answers are too few to learn from: ask at least {} of each",
                                   report.right, report.examples - report.right, kFewest));
  }
  const Scaling scaling = standardise(examples);
  const Weights weights = logistic(examples);
  Calibration& c = report.calibration;
  c.bias = weights[0];
  for (std::size_t i = 0; i < kFigures; ++i) {
    c.terms[i] = {weights[i + 1] / scaling.spread[i], scaling.max[i]};
    c.bias -= weights[i + 1] * scaling.mean[i] / scaling.spread[i];
  }
  c.highest = highest_of(examples, weights);
  c.position_sigma_scale = sigma_scale;
  c.heading_sigma_scale = heading_scale(errors, in_force);
  return report;
}

json calibration_json(const CalibrationReport& report, const json& origin) {
  const Calibration& c = report.calibration;
  json document{{"format", kCalibrationFormat},
                {"bias", c.bias},
                {"highest", c.highest},
                {"sigma_scale", {{"position", c.position_sigma_scale}, {"heading", c.heading_sigma_scale}}},
                {"origin", origin}};
  for (std::size_t i = 0; i < kFigures; ++i) {
    document["terms"][kCountedFigures[i].name] = {{"weight", c.terms[i].weight}, {"most", c.terms[i].max}};
  }
  document["origin"]["examples"] = report.examples;
  document["origin"]["right"] = report.right;
  document["origin"]["elsewhere"] = report.elsewhere;
  return document;
}

std::vector<std::string> notes_on(const CalibrationReport& report) {
  constexpr double kLeastOfRealGround = 0.5;
  const Calibration& learned = report.calibration;
  std::vector<std::string> notes;
  if (const double confidence = FixOptions{}.confidence; learned.highest < confidence) {
    notes.push_back(fmt::format(
        "these answers vouch for no probability above {:.4f}, and a fix takes {} unless told otherwise: with this "
        "calibration there is none. Ask more queries; 98 right answers that are surer than any wrong one are the least",
        learned.highest, confidence));
  }
  if (learned.position_sigma_scale < kLeastOfRealGround) {
    notes.push_back(fmt::format(
        "the right places lie {:.1f} times nearer to the truth than was stated, as where frames are simulated without "
        "shift_m, or rendered. No map of real ground is as accurate, but every position will be said to be",
        1.0 / learned.position_sigma_scale));
  }
  if (learned.heading_sigma_scale < kLeastOfRealGround) {
    notes.push_back(fmt::format(
        "the headings of right places lie {:.1f} times nearer to the truth than was stated, as where frames are "
        "simulated. Those of real frames do not, but every heading will be said to: learn that from imagery, with "
        "--calibrate-headings",
        1.0 / learned.heading_sigma_scale));
  }
  if (!report.kept.empty()) {
    notes.push_back(fmt::format(
        "the accuracy of {} stays as it was, since fewer than {} right answers tell of match and map: of the others "
        "most of the stated deviation is what their frames tell of camera, attitude or offsets",
        fmt::join(report.kept, " and "), kFewest));
  }
  return notes;
}

HeadingScale learn_heading_scale(std::span<const Outcome> outcomes, const Calibration& in_force) {
  const NormalisedErrors errors = normalised_errors(outcomes);
  const std::size_t right = errors.heading.size();
  if (right < kFewest) {
    throw InvalidInput("calibration-too-few-examples",
                       fmt::format("{} right answers whose frames do not tell most of the accuracy of their headings "
                                   "themselves are too few to learn from: ask for {} at least",
                                   right, kFewest));
  }
  return {heading_scale(errors, in_force), static_cast<int>(right)};
}

json with_heading_scale(std::string_view calibration, const HeadingScale& learned, const json& origin) {
  parse_calibration(calibration);  // or throws
  json document = json::parse(calibration);
  document["sigma_scale"]["heading"] = learned.scale;
  document["origin"]["heading"] = origin;
  document["origin"]["heading"]["right"] = learned.right;
  return document;
}

}  // namespace roadfix::bench
