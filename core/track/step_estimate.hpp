// What a step answers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/filter/clusters.hpp"
#include "core/filter/filter.hpp"
#include "core/track/tracker.hpp"

namespace roadfix {

/// What became of a step, beside the state that it leaves.
struct StepOutcome {
  Measurement measurement = Measurement::kNone;
  double mean_likelihood = 0.0;  ///< see TrackEstimate
  std::int64_t missed_steps = 0;
  std::optional<double> agl_m;  ///< see TrackEstimate
  std::optional<Unclaimed> unclaimed = Unclaimed::kTooFewAgree;
};

/// `state` after the step but for its filter, which is `filter`; `clusters` of its particles.
TrackEstimate estimate_of(const Tracker& tracker, const TrackerState& state, const Filter& filter,
                          std::span<const Cluster> clusters, const StepOutcome& outcome);

}  // namespace roadfix
