#include "core/track/tracker_step.hpp"

#include <cmath>
#include <utility>

#include "core/grid/relief.hpp"
#include "core/locate/other_places.hpp"
#include "core/locate/prepare.hpp"
#include "core/locate/soft_map.hpp"
#include "core/track/convergence.hpp"
#include "core/track/particle_likelihoods.hpp"
#include "core/track/track_geometry.hpp"

namespace roadfix {
namespace {

// 1 sigma per axis by which a belief spreads when a measurement contradicts it: the motion may have been less accurate
// than was told.
constexpr double kWidenedM = 4.0;

constexpr double kLongestGapS = 600.0;  // after a longer one the belief is thrown away
constexpr double kLeastKept = 0.99;     // of the weight: the vehicle may be among the particles that left the region

/// Seen from all of it a frame is displaced alike by the relief of the ground.
bool is_narrow(const Cluster& belief) {
  constexpr double kSigmaM = 30.0;
  constexpr double kTurnRad = 0.15;
  return belief.sigma_m() <= kSigmaM && belief.covariance[2][2] <= kTurnRad * kTurnRad;
}

ToldMotion told_motion(const TrackerState& before, const StepInput& input) {
  if (!before.last) return {input.odometry, input.covariance, 0.0, 0};
  return {input.odometry, input.covariance, 1e-6 * static_cast<double>(input.time_us - before.last->time_us),
          input.sequence - before.last->sequence - 1};
}

}  // namespace

Tracker::Step::Step(const Tracker& tracker, const TrackerState& before, const StepInput& input,
                    const StepLimits& limits)
    : tracker_(tracker),
      map_(tracker.map_),
      settings_(tracker.settings_),
      input_(input),
      limits_(limits),
      search_(map_, settings_, limits),
      state_(before),
      motion_(settings_.vehicle, tracker.region_, told_motion(before, input), before.motion),
      filter_(before.last ? Filter(settings_.filter, motion_.region(), std::move(state_.filter), limits.threads)
                          : Filter(settings_.filter, motion_.region(), settings_.seed, limits.threads)) {}

StepResult Tracker::Step::run() {
  const bool was_confirmed = state_.claim.confirmed;
  begin_or_move();
  if (input_.features) {
    take_in_features();
    see();
  }
  if (!saw_nothing()) motion_.see();
  // Frames that contradict the place may contradict what bounds it: the odometry, or that the start was known.
  if (was_confirmed && !state_.claim.confirmed) state_.reach.reset();
  state_.last = StepStamp{input_.sequence, input_.time_us};
  state_.motion = motion_.learned();
  const std::vector<Cluster> clusters = clusters_of(filter_.particles());
  outcome_.unclaimed = why_unclaimed(settings_, state_, clusters.front(), outcome_.measurement, filter_.doubt());
  // A claim that ended while nothing was seen does not come back when the particles happen to gather again.
  if (saw_nothing() && outcome_.unclaimed) state_.claim.forget_look();
  if (!outcome_.unclaimed) state_.recent.clear();
  TrackEstimate estimate = estimate_of(tracker_, state_, filter_, clusters, outcome_);
  state_.filter = filter_.state();
  return {std::move(state_), std::move(estimate)};
}

/// In the size that the ground below the particles has, and levelled where frames have told what lies around them.
FeatureMap Tracker::Step::seen_from_above_ground(const Altitude& told) {
  const Particles& particles = filter_.particles();
  double agl_m = told.agl_m;
  if (told.above_sea_m) {
    agl_m = mean_agl_m(map_, particles, *told.above_sea_m).value_or(agl_m);
    search_.see_from({told.above_sea_m, agl_m});
    outcome_.agl_m = agl_m;
  }
  FeatureMap seen = in_cells_of(map_, seen_from(*input_.features, told, agl_m));
  if (!map_.terrain || !state_.claim.outweighs_chance()) return seen;
  const Cluster belief = heaviest_of(particles);
  return is_narrow(belief) ? in_cells_of(map_, levelled(seen, Relief(*map_.terrain, belief.mean, agl_m))) : seen;
}

void Tracker::Step::take_in_features() {
  features_ = input_.altitude ? seen_from_above_ground(*input_.altitude) : in_cells_of(map_, *input_.features);
  // The particles do not include this error; it is added to the answer, once.
  state_.nadir_sigma_m = std::exchange(features_->nadir_sigma_m, 0.0);
}

void Tracker::Step::begin_or_move() {
  if (is_first()) {
    filter_.start_uniformly(tracker_.start_);
    if (begins_known()) state_.reach = Reach::within(tracker_.start_);
  } else {
    outcome_.missed_steps = motion_.told().lost_steps;
    move();
  }
}

void Tracker::Step::move() {
  const std::optional<Odometry>& odometry = motion_.told().odometry;
  state_.last_view.move(odometry, motion_.odometry_is_complete());
  if (motion_.told().seconds > kLongestGapS) {
    filter_.start_uniformly(tracker_.region_.poses);
    motion_.begin_anew();
    begin_claim_anew();
    state_.recent.clear();
    return;
  }
  if (state_.reach) motion_.carry(*state_.reach);
  if (state_.reach && state_.reach->is_lost()) {
    state_.reach.reset();
    state_.claim.reopen();
  }
  const double kept = motion_.move(filter_);
  if (kept == 0.0) {
    begin_claim_anew();
  } else if (kept < kLeastKept) {
    state_.claim = {};
  }
  state_.claim.fly(motion_.travelled_m());
  // Frames can be laid together only if the odometry is the motion over the ground, and their scale is known.
  if (odometry && motion_.odometry_is_complete() && settings_.vehicle.scale_range <= 0.0) {
    state_.recent.move(*odometry, motion_.odometry_covariance());
  } else {
    state_.recent.clear();
  }
}

void Tracker::Step::see() {
  const View view = state_.last_view.take_in(*input_.features, input_.picture);
  if (view == View::kNew) {
    measure();
    if (may_search()) state_.recent.keep(*features_);
    return;
  }
  outcome_.measurement = view == View::kMayStandStill ? Measurement::kUseless : Measurement::kRepeated;
  if (view == View::kStandsStill) state_.claim.reject();  // nobody knows whether the camera has stopped or the vehicle
}

ParticleMatches Tracker::Step::matches(const MapView& map, const FeatureMap& features) const {
  return match_particles(map, features, filter_.particles(), settings_.vehicle.scale_range, limits_.threads,
                         limits_.deadline.stop());
}

/// Neither the frame nor the ground below the belief has roads (a lake).
bool Tracker::Step::is_over_bare_ground() const {
  constexpr double kMinShareWithRoads = 0.5;
  return settings_.measurement_model.kind != LikelihoodKind::kEquation7 && !shows_roads(*features_) &&
         share_with_roads(filter_.particles(), matches(map_, *features_)) < kMinShareWithRoads;
}

/// The correlation is over half the log odds, as in a search; equation (7) is over probabilities.
std::optional<std::vector<double>> Tracker::Step::log_likelihoods() const {
  if (is_over_bare_ground()) return std::nullopt;
  const MeasurementModel& model = settings_.measurement_model;
  const bool correlates = model.kind == LikelihoodKind::kCorrelation;
  const ParticleMatches found = correlates ? matches(soft_view(map_), softened(*features_)) : matches(map_, *features_);
  return log_likelihoods_of(filter_.particles(), found, *features_, model);
}

void Tracker::Step::measure() {
  ++state_.measured;
  if (settings_.start == TrackStart::kSearch && !state_.searched && start_by_search()) return;
  if (const auto said = log_likelihoods()) {
    weigh(*said);
  } else {
    outcome_.measurement = Measurement::kUseless;
  }
  look_around_if_due();
  search_if_due();
}

void Tracker::Step::weigh(std::span<const double> log_likelihoods) {
  const GridPose believed = heaviest_of(filter_.particles()).mean;
  const Correction correction = filter_.correct(log_likelihoods);
  outcome_.mean_likelihood = correction.mean_likelihood;
  if (!correction.usable) {
    outcome_.measurement = Measurement::kUseless;
    return;
  }
  if (settings_.measurement_model.supports(correction.mean_likelihood)) {
    outcome_.measurement = Measurement::kAccepted;
    state_.claim.accept();
    state_.accepted_time_us = input_.time_us;
  } else {
    outcome_.measurement = Measurement::kRejected;
    state_.claim.reject();
    if (settings_.recovers) filter_.widen(kWidenedM);
  }
  state_.claim.weigh(std::log(correction.mean_likelihood));
  if (!is_same_place(heaviest_of(filter_.particles()).mean, believed)) state_.claim.reopen();
}

/// There was no frame, it said nothing about the place, or it was not new.
bool Tracker::Step::saw_nothing() const {
  return outcome_.measurement == Measurement::kNone || outcome_.measurement == Measurement::kUseless ||
         outcome_.measurement == Measurement::kRepeated;
}

void Tracker::Step::begin_claim_anew() {
  state_.claim = {};
  state_.searched = false;
  state_.reach.reset();
}

}  // namespace roadfix
