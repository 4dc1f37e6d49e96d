// What the answers of one method to one set of queries come to, as text and as the JSON of docs/bench.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/bench/manifest.hpp"
#include "cli/bench/query.hpp"
#include "core/survey/simulate.hpp"

namespace roadfix::bench {

inline constexpr double kFalseFixM = 25.0;  ///< a `fix` further off than this is a false one

struct Outcome {
  std::string id;
  std::optional<GeoPose> truth;
  Answer answer;
  std::optional<double> error_m;  ///< of the best guess, whatever the status; infinite where the truth is elsewhere
  std::optional<double> heading_error_deg;
  /// Squared error of the position in units of the stated ellipse, infinite where the truth is elsewhere; nullopt
  /// where no ellipse was stated.
  std::optional<double> position_nees;
  std::optional<double> heading_nees;  ///< likewise; nullopt also where the truth is elsewhere
};

/// Errors of an answer, in the plane of the zone.
Outcome judged(const std::string& id, const std::optional<GeoPose>& truth, Answer answer, const UtmZone& zone);

struct Summary {
  int n = 0;
  int answered = 0;  ///< status `fix`
  /// Shares of all queries, 0 to 1, whose best guess is at most so many metres off, whatever the status.
  double recall_5 = 0.0;
  double recall_10 = 0.0;
  double recall_25 = 0.0;
  double recall_50 = 0.0;
  int false_fixes = 0;                             ///< of the answered, further off than kFalseFixM
  std::optional<double> median_error_m;            ///< of the answered
  std::optional<double> median_heading_error_deg;  ///< of the answered
  double time_p50_ms = 0.0;                        ///< of all queries that took any
  double time_p95_ms = 0.0;
  std::optional<double> mean_matches;         ///< of keypoints, in a frame
  std::optional<double> mean_right_matches;   ///< of those
  std::optional<double> median_rho_at_truth;  ///< of roads
};

Summary summary_of(const std::vector<Outcome>& outcomes);

struct SetResult {
  MethodName method = MethodName::kRoads;
  std::string map;
  std::string query_set;  ///< as describe() names it
  std::vector<Outcome> outcomes;
  double footprint_m = 0.0;                    ///< shorter side, 0 for real frames
  bool elsewhere = false;                      ///< no query shows ground of the map
  std::optional<FeatureQuality> quality = {};  ///< of simulated queries, where it is the same for all of them
  std::size_t set = 1;                         ///< number of the query set in the manifest, from 1 on
};

/// With the honesty of the set (honesty.hpp).
nlohmann::json to_json(const SetResult& result);
/// All outcomes of MethodName::kRoads.
std::vector<Outcome> road_outcomes(const std::vector<SetResult>& results);

std::string to_table(const std::vector<SetResult>& results);

}  // namespace roadfix::bench
