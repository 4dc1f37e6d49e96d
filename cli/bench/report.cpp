#include "cli/bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/bench/honesty.hpp"
#include "cli/evaluation/nees.hpp"
#include "cli/evaluation/statistics.hpp"
#include "core/locate/calibration.hpp"
#include "server/api/features.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/json_parts.hpp"

namespace roadfix::bench {
namespace {

using evaluation::mean;
using evaluation::quantile;
using nlohmann::json;

constexpr double kNowhere = std::numeric_limits<double>::infinity();

json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}

json figures_json(const std::optional<SearchFigures>& figures) {
  if (!figures) return nullptr;
  json result{{"agreement", figures->agreement}, {"other_roads_across", number_or_null(figures->other_roads_across)}};
  for (const CountedFigure& counted : kCountedFigures) result[counted.name] = (*figures).*counted.value;
  return result;
}

json keypoints_json(const std::optional<KeypointCounts>& counts) {
  if (!counts) return nullptr;
  return {{"matches", counts->matches}, {"right", counts->right}};
}

/// What position_nees is reckoned with.
json ellipse_json(const std::optional<FixMode>& mode) {
  if (!mode) return nullptr;
  return {{"sigma_m", mode->ellipse.sigma_m},
          {"heading_deg", mode->ellipse.heading.degrees()},
          {"heading_sigma_deg", mode->heading_sigma.degrees()}};
}

json outcome_json(const Outcome& outcome) {
  const Answer& answer = outcome.answer;
  return {{"id", outcome.id},
          {"truth", outcome.truth ? api::pose_json(*outcome.truth) : json(nullptr)},
          {"status", api::to_string(answer.status)},
          {"reason", answer.reason},
          {"answer", answer.best ? api::pose_json(*answer.best) : json(nullptr)},
          {"ellipse", ellipse_json(answer.mode)},
          {"probability", answer.probability},
          {"left_out", api::frame_numbers(answer.left_out)},
          {"evidence", figures_json(answer.figures)},
          {"error_m", number_or_null(outcome.error_m)},
          {"heading_error_deg", number_or_null(outcome.heading_error_deg)},
          {"position_nees", number_or_null(outcome.position_nees)},
          {"heading_nees", number_or_null(outcome.heading_nees)},
          {"keypoints", keypoints_json(answer.keypoints)},
          {"rho_at_truth", number_or_null(answer.rho_at_truth)},
          {"time_ms", answer.time_ms}};
}

double position_nees(const FixMode& mode, LatLon truth, const UtmZone& zone) {
  const GridPoint at = zone.project(mode.pose.position);
  return evaluation::nees(at, on_grid(mode.ellipse, zone, at), zone.project(truth));
}

std::string cell(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
}

/// What of the true place was seen again.
std::string at_truth(const Summary& s) {
  if (s.mean_matches) return fmt::format("{:.1f} of {:.0f} matches right", *s.mean_right_matches, *s.mean_matches);
  return s.median_rho_at_truth ? fmt::format("rho {:.2f}", *s.median_rho_at_truth) : std::string("-");
}

}  // namespace

Outcome judged(const std::string& id, const std::optional<GeoPose>& truth, Answer answer, const UtmZone& zone) {
  Outcome outcome{id, truth, std::move(answer), {}, {}, {}, {}};
  const auto& best = outcome.answer.best;
  if (best && !truth) {
    outcome.error_m = kNowhere;
  } else if (best) {
    outcome.error_m = distance_m(zone.project(best->position), zone.project(truth->position));
    outcome.heading_error_deg = angular_distance(best->heading, truth->heading).degrees();
  }
  if (const auto& mode = outcome.answer.mode) {
    outcome.position_nees = truth ? position_nees(*mode, truth->position, zone) : kNowhere;
    if (truth) outcome.heading_nees = evaluation::heading_nees(mode->pose.heading, mode->heading_sigma, truth->heading);
  }
  return outcome;
}

Summary summary_of(const std::vector<Outcome>& outcomes) {
  Summary result;
  result.n = static_cast<int>(outcomes.size());
  std::vector<double> errors;
  std::vector<double> heading_errors;
  std::vector<double> times;
  std::vector<double> matches;
  std::vector<double> right_matches;
  std::vector<double> rhos;
  for (const Outcome& outcome : outcomes) {
    if (outcome.answer.time_ms > 0.0) times.push_back(outcome.answer.time_ms);
    if (const auto& counts = outcome.answer.keypoints) {
      matches.push_back(counts->matches);
      right_matches.push_back(counts->right);
    }
    if (outcome.answer.rho_at_truth) rhos.push_back(*outcome.answer.rho_at_truth);
    if (outcome.answer.status != FixStatus::kFix) continue;
    ++result.answered;
    errors.push_back(outcome.error_m.value());
    if (outcome.heading_error_deg) heading_errors.push_back(*outcome.heading_error_deg);
    if (*outcome.error_m > kFalseFixM) ++result.false_fixes;
  }
  const auto recall = [&](double within_m) {
    const auto hits =
        std::ranges::count_if(outcomes, [&](const Outcome& o) { return o.error_m && *o.error_m <= within_m; });
    return outcomes.empty() ? 0.0 : static_cast<double>(hits) / static_cast<double>(outcomes.size());
  };
  result.recall_5 = recall(5.0);
  result.recall_10 = recall(10.0);
  result.recall_25 = recall(25.0);
  result.recall_50 = recall(50.0);
  result.median_error_m = quantile(errors, 0.5);
  result.median_heading_error_deg = quantile(heading_errors, 0.5);
  result.time_p50_ms = quantile(times, 0.5).value_or(0.0);
  result.time_p95_ms = quantile(times, 0.95).value_or(0.0);
  result.mean_matches = mean(matches);
  result.mean_right_matches = mean(right_matches);
  result.median_rho_at_truth = quantile(rhos, 0.5);
  return result;
}

json to_json(const SetResult& result) {
  const Summary s = summary_of(result.outcomes);
  json queries = json::array();
  for (const Outcome& outcome : result.outcomes) queries.push_back(outcome_json(outcome));
  return {{"method", to_string(result.method)},
          {"map", result.map},
          {"set", result.set},
          {"query_set", result.query_set},
          {"n", s.n},
          {"answered", s.answered},
          {"recall", {{"5", s.recall_5}, {"10", s.recall_10}, {"25", s.recall_25}, {"50", s.recall_50}}},
          {"false_fixes", s.false_fixes},
          {"median_error_m", number_or_null(s.median_error_m)},
          {"median_heading_error_deg", number_or_null(s.median_heading_error_deg)},
          {"time_ms", {{"p50", s.time_p50_ms}, {"p95", s.time_p95_ms}}},
          {"mean_matches", number_or_null(s.mean_matches)},
          {"mean_right_matches", number_or_null(s.mean_right_matches)},
          {"median_rho_at_truth", number_or_null(s.median_rho_at_truth)},
          {"honesty", to_json(honesty_of(result.outcomes))},
          {"queries", queries}};
}

std::vector<Outcome> road_outcomes(const std::vector<SetResult>& results) {
  std::vector<Outcome> outcomes;
  for (const SetResult& result : results) {
    if (result.method == MethodName::kRoads)
      outcomes.insert(outcomes.end(), result.outcomes.begin(), result.outcomes.end());
  }
  return outcomes;
}

std::string to_table(const std::vector<SetResult>& results) {
  std::size_t map_width = 3;
  std::size_t set_width = 7;
  for (const SetResult& result : results) {
    map_width = std::max(map_width, result.map.size());
    set_width = std::max(set_width, result.query_set.size());
  }
  std::string table =
      fmt::format("{:<8}{:<{}}  {:<{}}{:>5}{:>9}{:>7}{:>7}{:>7}{:>7}{:>7}{:>9}{:>9}{:>9}{:>9}  {}\n", "method", "map",
                  map_width, "queries", set_width, "n", "answered", "r@5", "r@10", "r@25", "r@50", "false", "med. m",
                  "med. deg", "p50 ms", "p95 ms", "at the true place");
  for (const SetResult& result : results) {
    const Summary s = summary_of(result.outcomes);
    table += fmt::format(
        "{:<8}{:<{}}  {:<{}}{:>5}{:>9}{:>7.2f}{:>7.2f}{:>7.2f}{:>7.2f}{:>7}{:>9}{:>9}{:>9.0f}{:>9.0f}  {}\n",
        to_string(result.method), result.map, map_width, result.query_set, set_width, s.n, s.answered, s.recall_5,
        s.recall_10, s.recall_25, s.recall_50, s.false_fixes, cell(s.median_error_m, 1),
        cell(s.median_heading_error_deg, 2), s.time_p50_ms, s.time_p95_ms, at_truth(s));
  }
  return table;
}

}  // namespace roadfix::bench
