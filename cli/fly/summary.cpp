#include "cli/fly/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/evaluation/intervals.hpp"
#include "cli/evaluation/nees.hpp"
#include "cli/evaluation/statistics.hpp"

namespace roadfix::fly {
namespace {

using evaluation::mean;
using evaluation::quantile;

constexpr double kMaxWeight = 0.5;

bool near(const Record& record) { return record.error_m <= kFoundM; }

double frames_until(std::span<const Record> records, std::size_t index) {
  const auto until = records.first(index + 1);
  return static_cast<double>(std::ranges::count_if(until, [](const Record& r) { return r.saw; }));
}

/// What is gathered over all runs before it is condensed.
struct Samples {
  std::vector<double> updates, errors, final_errors, claim_updates, nees, step_ms, particles, recovery_s, withdrawal_s;
};

void add_claims(std::span<const Record> records, Summary& summary, Samples& samples) {
  bool claimed = false;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& record = records[i];
    if (!record.estimate.converged()) continue;
    if (!claimed) {
      ++summary.claimed_runs;
      samples.claim_updates.push_back(frames_until(records, i));
      if (!near(record)) ++summary.first_claim_false;
    }
    claimed = true;
    ++summary.claims;
    if (!near(record)) ++summary.false_claims;
    samples.nees.push_back(record.nees);
  }
}

void add_search(std::span<const Record> records, Summary& summary, Samples& samples) {
  if (const auto found = found_at(records)) {
    ++summary.found;
    samples.updates.push_back(frames_until(records, *found));
    for (const Record& record : records.subspan(*found)) samples.errors.push_back(record.error_m);
  }
}

void add_end(const Record& last, Summary& summary, Samples& samples) {
  samples.final_errors.push_back(last.error_m);
  if (!near(last) && last.estimate.clusters.front().weight >= kMaxWeight) ++summary.wrong_at_end;
}

void add_event(std::span<const Record> records, const Events& events, Summary& summary, Samples& samples) {
  const int event = events.kidnapping ? events.kidnapping->step : events.outage ? events.outage->end : -1;
  if (event < 1 || static_cast<std::size_t>(event) >= records.size()) return;
  const auto first = static_cast<std::size_t>(event);
  const double at_s = records[first].time_s;
  if (const auto found = found_at(records, first)) {
    ++summary.recovered;
    samples.recovery_s.push_back(records[*found].time_s - at_s);
  }
  if (!events.kidnapping || !records[first - 1].estimate.converged()) return;
  const auto withdrawn =
      std::ranges::find_if(records.subspan(first), [](const Record& r) { return !r.estimate.converged(); });
  if (withdrawn != records.end()) samples.withdrawal_s.push_back(withdrawn->time_s - at_s);
}

std::optional<double> share_below(const std::vector<double>& values, double limit) {
  if (values.empty()) return std::nullopt;
  const auto below = std::ranges::count_if(values, [&](double value) { return value <= limit; });
  return static_cast<double>(below) / static_cast<double>(values.size());
}

void condense(const Samples& samples, Summary& summary) {
  summary.updates_median = quantile(samples.updates, 0.5);
  summary.updates_p90 = quantile(samples.updates, 0.9);
  summary.error_median_m = quantile(samples.errors, 0.5);
  summary.error_p90_m = quantile(samples.errors, 0.9);
  summary.final_error_median_m = quantile(samples.final_errors, 0.5);
  summary.final_error_p90_m = quantile(samples.final_errors, 0.9);
  summary.claim_updates_median = quantile(samples.claim_updates, 0.5);
  summary.nees_mean = mean(samples.nees);
  summary.within_95 = share_below(samples.nees, evaluation::kChiSquare95);
  summary.step_ms_median = quantile(samples.step_ms, 0.5);
  summary.step_ms_p95 = quantile(samples.step_ms, 0.95);
  summary.particles_mean = mean(samples.particles);
  summary.recovery_s_median = quantile(samples.recovery_s, 0.5);
  summary.recovery_s_p90 = quantile(samples.recovery_s, 0.9);
  summary.withdrawal_s_median = quantile(samples.withdrawal_s, 0.5);
}

// Runs are independent of each other, their steps are not.
nlohmann::json share_95(int hits, int n) { return evaluation::to_json(evaluation::clopper_pearson(hits, n)); }

nlohmann::json or_null(const std::optional<double>& value) { return value ? nlohmann::json(*value) : nlohmann::json(); }

std::string text(const std::optional<double>& value, int digits = 1) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

}  // namespace

std::optional<std::size_t> found_at(std::span<const Record> records, std::size_t from) {
  for (std::size_t i = from; i < records.size(); ++i) {
    const std::size_t end = std::min(records.size(), i + kStaySteps);
    if (std::all_of(records.begin() + static_cast<std::ptrdiff_t>(i),
                    records.begin() + static_cast<std::ptrdiff_t>(end), near)) {
      return i;
    }
  }
  return std::nullopt;
}

Summary summary_of(std::span<const Run> runs, const Events& events) {
  Summary summary;
  Samples samples;
  for (const Run& run : runs) {
    if (run.records.empty()) continue;
    ++summary.runs;
    // Before a kidnapping the search is as without one.
    std::span<const Record> before(run.records);
    if (events.kidnapping && static_cast<std::size_t>(events.kidnapping->step) < before.size()) {
      before = before.first(static_cast<std::size_t>(events.kidnapping->step));
    }
    add_search(before, summary, samples);
    add_end(run.records.back(), summary, samples);
    add_claims(run.records, summary, samples);
    add_event(run.records, events, summary, samples);
    for (const Record& record : run.records) {
      if (record.saw) samples.step_ms.push_back(record.step_ms);
      samples.particles.push_back(static_cast<double>(record.estimate.particles));
    }
  }
  condense(samples, summary);
  return summary;
}

nlohmann::json to_json(const Summary& s) {
  return {{"runs", s.runs},
          {"found", s.found},
          {"found_share_95", share_95(s.found, s.runs)},
          {"updates_to_find", {{"median", or_null(s.updates_median)}, {"p90", or_null(s.updates_p90)}}},
          {"error_m", {{"median", or_null(s.error_median_m)}, {"p90", or_null(s.error_p90_m)}}},
          {"final_error_m", {{"median", or_null(s.final_error_median_m)}, {"p90", or_null(s.final_error_p90_m)}}},
          {"wrong_at_end", s.wrong_at_end},
          {"claims",
           {{"runs", s.claimed_runs},
            {"runs_share_95", share_95(s.claimed_runs, s.runs)},
            {"first_false", s.first_claim_false},
            {"first_false_share_95", share_95(s.first_claim_false, s.claimed_runs)},
            {"updates_median", or_null(s.claim_updates_median)},
            {"steps", s.claims},
            {"false_steps", s.false_claims},
            {"nees_mean", or_null(s.nees_mean)},
            {"within_95_ellipse", or_null(s.within_95)}}},
          {"step_ms", {{"median", or_null(s.step_ms_median)}, {"p95", or_null(s.step_ms_p95)}}},
          {"particles_mean", or_null(s.particles_mean)},
          {"recovered", s.recovered},
          {"recovered_share_95", share_95(s.recovered, s.runs)},
          {"recovery_s", {{"median", or_null(s.recovery_s_median)}, {"p90", or_null(s.recovery_s_p90)}}},
          {"withdrawal_s", {{"median", or_null(s.withdrawal_s_median)}}}};
}

std::string to_table(std::span<const std::pair<std::string, Summary>> summaries, const Events& events) {
  constexpr std::string_view kRow = "{:<11} {:>5} {:>6} {:>13} {:>15} {:>15} {:>6} {:>14} {:>12} {:>11} {:>6} {:>14}\n";
  std::string table = fmt::format(kRow, "filter", "runs", "found", "updates (90%)", "error m (90%)", "final m (90%)",
                                  "wrong", "claims (at)", "false steps", "NEES", "in 95", "ms/step (95%)");
  for (const auto& [name, s] : summaries) {
    table += fmt::format(kRow, name, s.runs, s.found,
                         fmt::format("{} ({})", text(s.updates_median, 0), text(s.updates_p90, 0)),
                         fmt::format("{} ({})", text(s.error_median_m), text(s.error_p90_m)),
                         fmt::format("{} ({})", text(s.final_error_median_m), text(s.final_error_p90_m)),
                         s.wrong_at_end, fmt::format("{} ({})", s.claimed_runs, text(s.claim_updates_median, 0)),
                         fmt::format("{}/{}", s.false_claims, s.claims), text(s.nees_mean), text(s.within_95, 2),
                         fmt::format("{} ({})", text(s.step_ms_median), text(s.step_ms_p95)));
  }
  if (!events.kidnapping && !events.outage) return table;
  table += events.kidnapping ? "\nafter the kidnapping:\n" : "\nafter the outage:\n";
  for (const auto& [name, s] : summaries) {
    table += fmt::format(
        "{:<11}{} of {} found again, after {} s (90 %: {} s){}\n", name, s.recovered, s.runs,
        text(s.recovery_s_median, 0), text(s.recovery_s_p90, 0),
        s.withdrawal_s_median ? fmt::format(", its claim withdrawn after {} s", text(s.withdrawal_s_median, 0)) : "");
  }
  return table;
}

}  // namespace roadfix::fly
