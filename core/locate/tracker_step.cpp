#include "core/locate/tracker_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/locate/prepare.hpp"
#include "core/locate/track_geometry.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

// 1 sigma per axis by which a belief spreads where a measurement speaks against it: the motion may have been worse than
// was told.
constexpr double kWidenedM = 4.0;

}  // namespace

Tracker::Step::Step(const Tracker& tracker, const TrackerState& before, const StepInput& input,
                    const StepLimits& limits)
    : tracker_(tracker),
      settings_(tracker.settings_),
      input_(input),
      limits_(limits),
      state_(before),
      filter_(before.started ? Filter(settings_.filter, region(), std::move(state_.filter), limits.threads)
                             : Filter(settings_.filter, region(), settings_.seed, limits.threads)) {}

StepResult Tracker::Step::run() {
  require_in_order();
  if (input_.features) {
    features_ = in_cells_of(tracker_.map_, *input_.features);
    // What the particles do not know is added to what they say, once.
    state_.nadir_sigma_m = std::exchange(features_->nadir_sigma_m, 0.0);
  }
  if (state_.started) {
    estimate_.missed_steps = input_.sequence - state_.sequence - 1;
    state_.last_view.move(input_.odometry, wind().is_none() && estimate_.missed_steps == 0);
    move();
  } else {
    filter_.start_uniformly(tracker_.start_);
    state_.started = true;
  }
  if (features_) see();
  state_.sequence = input_.sequence;
  state_.time_us = input_.time_us;
  fill_estimate();
  if (estimate_.converged) state_.recent.clear();
  state_.filter = filter_.state();
  return {std::move(state_), std::move(estimate_)};
}

void Tracker::Step::see() {
  const View view = state_.last_view.look(*input_.features);
  if (view == View::kNew) {
    measure();
    if (may_search()) state_.recent.keep(*features_);
    return;
  }
  estimate_.measurement = Measurement::kRepeated;
  if (view == View::kStandsStill) {  // and nobody knows whether the camera has stopped or the vehicle
    state_.claim.reject();
    state_.looked_time_us.reset();
  }
}

void Tracker::Step::require_in_order() const {
  if (!state_.started) return;
  if (input_.sequence <= state_.sequence) {
    throw InvalidInput("step-late", fmt::format("step {} arrived after step {}: numbers must increase; drop late steps",
                                                input_.sequence, state_.sequence));
  }
  if (input_.time_us <= state_.time_us) {
    throw InvalidInput(
        "time-backwards",
        fmt::format(
            "the capture time {} us is not after that of the last step, {} us: set the clock, or begin a new track",
            input_.time_us, state_.time_us));
  }
}

double Tracker::Step::seconds() const { return 1e-6 * static_cast<double>(input_.time_us - state_.time_us); }

std::optional<double> Tracker::Step::since_accepted_s() const {
  if (!state_.accepted_time_us) return std::nullopt;
  return 1e-6 * static_cast<double>(input_.time_us - *state_.accepted_time_us);
}

void Tracker::Step::measure() {
  ++state_.measured;
  if (settings_.measure_every > 1 && state_.measured % settings_.measure_every != 1) {
    estimate_.measurement = Measurement::kSkipped;
    return;
  }
  if (settings_.start == TrackStart::kSearch && !state_.searched && start_by_search()) return;
  const ParticleMatches matches = match_particles(tracker_.map_, *features_, filter_.particles(),
                                                  settings_.vehicle.scale_range, limits_.threads, limits_.stop);
  const auto frame_cells = static_cast<std::int64_t>(features_->cells.observed_count());
  if (frame_cells == 0 || is_unseen_by_map(matches.sums, frame_cells)) {
    estimate_.measurement = Measurement::kUseless;
  } else {
    weigh(matches, frame_cells);
  }
  look_around_if_due();
  search_if_due();
}

void Tracker::Step::weigh(const ParticleMatches& matches, std::int64_t frame_cells) {
  std::vector<double> log_likelihoods(matches.sums.size());
  for (std::size_t i = 0; i < log_likelihoods.size(); ++i) {
    // A frame says as much of larger ground as of smaller: its cells are larger then, and not more.
    const double scale = matches.scales[i];
    const auto cells = std::llround(scale * scale * static_cast<double>(frame_cells));
    log_likelihoods[i] = settings_.measurement_model.log_likelihood(matches.sums[i], cells, features_->cell_m / scale);
  }
  const Correction correction = filter_.correct(log_likelihoods);
  estimate_.mean_likelihood = correction.mean_likelihood;
  if (!correction.usable) {
    estimate_.measurement = Measurement::kUseless;
    return;
  }
  if (settings_.measurement_model.supports(correction.mean_likelihood)) {
    estimate_.measurement = Measurement::kAccepted;
    state_.claim.accept();
    state_.accepted_time_us = input_.time_us;
  } else {
    estimate_.measurement = Measurement::kRejected;
    state_.claim.reject();
    state_.looked_time_us.reset();
    if (settings_.recovers) filter_.widen(kWidenedM);
  }
  state_.claim.weigh(std::log(correction.mean_likelihood));
}

/// Whether the belief lies where the map shows next to nothing, so that a frame speaks neither for nor against it.
bool Tracker::Step::is_unseen_by_map(std::span<const MatchSums> sums, std::int64_t frame_cells) const {
  constexpr double kMinShare = 0.25;
  if (settings_.measurement_model.kind == LikelihoodKind::kEquation7) return false;
  const Particles& p = filter_.particles();
  double seen = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) seen += p.weight[i] * static_cast<double>(sums[i].n);
  return seen < kMinShare * static_cast<double>(frame_cells);
}

void Tracker::Step::forget_support() {
  state_.claim = {};
  state_.searched = false;
}

void Tracker::Step::fill_estimate() {
  estimate_.sequence = state_.sequence;
  estimate_.time_us = state_.time_us;
  const std::vector<Cluster> clusters = clusters_of(filter_.particles(), settings_.clusters);
  estimate_.cluster_count = clusters.size();
  const double nadir_sigma_m = settings_.vehicle.nadir_sigma_m.value_or(state_.nadir_sigma_m);
  for (std::size_t i = 0; i < std::min(clusters.size(), TrackEstimate::kMaxClusters); ++i) {
    estimate_.clusters.push_back(to_geographic(tracker_.map_, clusters[i], nadir_sigma_m));
  }
  estimate_.particles = filter_.particles().size();
  estimate_.resets = filter_.state().resets;
  estimate_.doubt = filter_.doubt();
  estimate_.since_accepted_s = since_accepted_s();
  estimate_.drifts = state_.drifts;
  estimate_.converged = has_converged(clusters.front());
}

bool Tracker::Step::has_converged(const Cluster& best) const {
  return best.weight >= settings_.converged_weight && best.sigma_m() <= settings_.converged_sigma_m &&
         estimate_.measurement != Measurement::kRejected && !state_.last_view.stands_still &&
         state_.claim.is_supported() && is_borne_out() && filter_.doubt() <= kMaxDoubt &&
         since_accepted_s().value_or(kStaleAfterS) < kStaleAfterS;
}

/// Equation (7) is no ratio to chance, and bears out what it does not reject. Where no look
/// has borne the place out of late there is no time of one.
bool Tracker::Step::is_borne_out() const {
  if (settings_.measurement_model.kind == LikelihoodKind::kEquation7) return true;
  if (!state_.claim.outweighs_chance()) return false;
  return !settings_.recovers || (state_.claim.confirmed && state_.looked_time_us);
}

}  // namespace roadfix
