// What a step answers: where the vehicle is taken to be, and whether that may be claimed.
#pragma once

#include <cstdint>

#include "core/filter/filter.hpp"
#include "core/locate/tracker.hpp"

namespace roadfix {

/// What became of a step, beside the state that it leaves.
struct StepOutcome {
  Measurement measurement = Measurement::kNone;
  double mean_likelihood = 0.0;  ///< see TrackEstimate
  std::int64_t missed_steps = 0;
};

/// `state` after the step but for its filter, which is `filter`.
TrackEstimate estimate_of(const Tracker& tracker, const TrackerState& state, const Filter& filter,
                          const StepOutcome& outcome);

}  // namespace roadfix
