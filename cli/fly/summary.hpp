// What many flights say about a filter.
//
// A filter has *found* the vehicle when its best guess comes within kFoundM of the truth and stays there for
// kStaySteps steps (or to the end): that asks nothing of what the filter thinks of itself, so that filters can be
// compared. What it *claims* (status converged) is judged apart: a claim further off than kFoundM is a false one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/fly/localizer.hpp"
#include "core/units/index_range.hpp"

namespace roadfix::fly {

inline constexpr double kFoundM = 25.0;
inline constexpr int kStaySteps = 10;

struct Run {
  std::uint64_t seed = 0;
  std::vector<Record> records;
};

/// Index of the record from which on the vehicle is found; nullopt for never. Looks from `from` on.
std::optional<std::size_t> found_at(std::span<const Record> records, std::size_t from = 0);

/// Steps of a flight at which something happened, for what came of it.
struct Events {
  std::optional<Kidnapping> kidnapping;
  std::optional<IndexRange> outage;
};

struct Summary {
  int runs = 0;
  int found = 0;
  std::optional<double> updates_median;  ///< frames until found, over the runs that did
  std::optional<double> updates_p90;
  std::optional<double> error_median_m;  ///< of all steps from found on
  std::optional<double> error_p90_m;
  std::optional<double> final_error_median_m;  ///< of the last step of all runs
  std::optional<double> final_error_p90_m;
  int wrong_at_end = 0;       ///< runs whose heaviest cluster holds most of the weight at the end, at a wrong place
  int claimed_runs = 0;       ///< runs with a claim
  int first_claim_false = 0;  ///< runs whose first claim was a false one
  std::optional<double> claim_updates_median;  ///< frames until the first claim
  int claims = 0;                              ///< steps with a claim
  int false_claims = 0;                        ///< steps
  std::optional<double> nees_mean;             ///< over the claims; a consistent filter gives 2
  std::optional<double> within_95;             ///< share of the claims whose 95 % ellipse holds the truth
  std::optional<double> step_ms_median;        ///< of a step with a frame, by the localizer's clock
  std::optional<double> step_ms_p95;
  std::optional<double> particles_mean;
  // Where the plan has an event:
  int recovered = 0;                        ///< runs that found the vehicle again
  std::optional<double> recovery_s_median;  ///< from the event's end
  std::optional<double> recovery_s_p90;
  std::optional<double> withdrawal_s_median;  ///< from the jump until the claim was withdrawn, where there was one
};

Summary summary_of(std::span<const Run> runs, const Events& events);

/// With the 95 % intervals (Clopper and Pearson) of shares of runs.
nlohmann::json to_json(const Summary& summary);
/// One line for each filter.
std::string to_table(std::span<const std::pair<std::string, Summary>> summaries, const Events& events);

}  // namespace roadfix::fly
