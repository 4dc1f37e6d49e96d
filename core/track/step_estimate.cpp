#include "core/track/step_estimate.hpp"

#include <algorithm>
#include <cstddef>

#include "core/track/track_geometry.hpp"

namespace roadfix {

TrackEstimate estimate_of(const Tracker& tracker, const TrackerState& state, const Filter& filter,
                          std::span<const Cluster> clusters, const StepOutcome& outcome) {
  TrackEstimate estimate;
  estimate.sequence = state.last->sequence;
  estimate.time_us = state.last->time_us;
  estimate.unclaimed = outcome.unclaimed;
  estimate.cluster_count = clusters.size();
  const double nadir_sigma_m = tracker.settings().vehicle.nadir_sigma_m.value_or(state.nadir_sigma_m);
  for (std::size_t i = 0; i < std::min(clusters.size(), TrackEstimate::kMaxClusters); ++i) {
    estimate.clusters.push_back(to_geographic(tracker.map(), clusters[i], nadir_sigma_m));
  }
  estimate.particles = filter.particles().size();
  estimate.resets = filter.state().resets;
  estimate.measurement = outcome.measurement;
  estimate.mean_likelihood = outcome.mean_likelihood;
  estimate.doubt = filter.doubt();
  estimate.since_accepted_s = state.since_accepted_s(estimate.time_us);
  estimate.odometry_is_wrong = state.motion.odometry_is_wrong;
  estimate.agl_m = outcome.agl_m;
  estimate.missed_steps = outcome.missed_steps;
  return estimate;
}

}  // namespace roadfix
