#include "core/locate/step_estimate.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/locate/track_geometry.hpp"

namespace roadfix {
namespace {

constexpr double kConvergedWeight = 0.9;
constexpr double kConvergedSigmaM = 25.0;

/// Equation (7) is no ratio to chance, and bears out what it does not reject. Where no look has borne the place out of
/// late there is no time of one.
bool is_borne_out(const TrackSettings& settings, const TrackerState& state) {
  if (settings.measurement_model.kind == LikelihoodKind::kEquation7) return true;
  if (!state.claim.outweighs_chance()) return false;
  return !settings.recovers || (state.claim.confirmed && state.claim.looked_time_us);
}

bool has_converged(const TrackSettings& settings, const TrackerState& state, const Cluster& best,
                   const TrackEstimate& estimate) {
  return best.weight >= kConvergedWeight && best.sigma_m() <= kConvergedSigmaM &&
         estimate.measurement != Measurement::kRejected && estimate.measurement != Measurement::kRepeated &&
         !state.last_view.stands_still && state.claim.is_supported() && is_borne_out(settings, state) &&
         estimate.doubt <= kMaxDoubt && estimate.since_accepted_s.value_or(kStaleAfterS) < kStaleAfterS;
}

}  // namespace

TrackEstimate estimate_of(const Tracker& tracker, const TrackerState& state, const Filter& filter,
                          const StepOutcome& outcome) {
  const TrackSettings& settings = tracker.settings();
  TrackEstimate estimate;
  estimate.sequence = state.sequence;
  estimate.time_us = state.time_us;
  const std::vector<Cluster> clusters = clusters_of(filter.particles());
  estimate.cluster_count = clusters.size();
  const double nadir_sigma_m = settings.vehicle.nadir_sigma_m.value_or(state.nadir_sigma_m);
  for (std::size_t i = 0; i < std::min(clusters.size(), TrackEstimate::kMaxClusters); ++i) {
    estimate.clusters.push_back(to_geographic(tracker.map(), clusters[i], nadir_sigma_m));
  }
  estimate.particles = filter.particles().size();
  estimate.resets = filter.state().resets;
  estimate.measurement = outcome.measurement;
  estimate.mean_likelihood = outcome.mean_likelihood;
  estimate.doubt = filter.doubt();
  estimate.since_accepted_s = state.since_accepted_s(state.time_us);
  estimate.drifts = state.motion.drifts;
  estimate.missed_steps = outcome.missed_steps;
  estimate.converged = has_converged(settings, state, clusters.front(), estimate);
  return estimate;
}

}  // namespace roadfix
