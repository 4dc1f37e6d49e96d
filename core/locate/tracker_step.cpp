#include "core/locate/tracker_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/locate/prepare.hpp"
#include "core/locate/track_geometry.hpp"
#include "core/locate/track_motion.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

// The altitude's error wanders by this share of its range per square root of a second, with the relief below and the
// air pressure.
constexpr double kScaleWalkShare = 0.03;

// 1 sigma per axis by which a belief spreads where a measurement speaks against it: the motion may have been worse than
// was told.
constexpr double kWidenedM = 4.0;

// Of a vehicle that no odometry tells of: so much of its speed, and at least so many m/s, its velocity changes by
// within a second (1 sigma per axis). A turn of 15 degrees a second changes it by a quarter.
constexpr double kManoeuvreShare = 0.5;
constexpr double kLeastManoeuvreMS = 1.0;

// 1 sigma per axis of the wind that is learned where the odometry was found wrong, if no stronger one is told: so much
// of the speed, and at least so many m/s.
constexpr double kFoundWindShare = 0.3;
constexpr double kLeastFoundWindMS = 5.0;
constexpr double kTriedShare = 0.1;  // of the particles, before it is found wrong

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

/// That the last odometry told; where none is to be expected, that of the vehicle.
double Tracker::Step::speed_m_s() const {
  if (state_.velocity) return std::hypot(state_.velocity->forward_m_s, state_.velocity->right_m_s);
  return settings_.vehicle.planar ? std::abs(settings_.vehicle.planar->speed_m_s.mean) : 0.0;
}

void Tracker::Step::move() {
  if (seconds() > static_cast<double>(settings_.longest_gap.count())) {
    filter_.start_uniformly(tracker_.region_.poses);
    forget_support();
    state_.recent.clear();
    state_.velocity.reset();
    state_.coasts = coasts();
    return;
  }
  if (!predict_motion()) forget_support();
}

template <MotionModel Motion>
bool Tracker::Step::predict(const Motion& motion) {
  const double range = settings_.vehicle.scale_range;
  if (range == 0.0) return filter_.predict(motion);
  const ScaleWalk scale_walk{seconds(), kScaleWalkShare * range, tracker_.region_.max_log_scale};
  return filter_.predict([&](ParticleState& state, RandomStream& random) {
    motion(state, random);
    scale_walk(state, random);
  });
}

Wind Tracker::Step::wind() const {
  const Wind& told = settings_.vehicle.wind;
  if (!state_.drifts) return told;
  const Wind found = Wind::of(std::max(kLeastFoundWindMS, kFoundWindShare * speed_m_s()), std::nullopt);
  return {std::max(told.sigma_m_s, found.sigma_m_s), std::max(told.walk, found.walk)};
}

/// Some particles try other velocities. Should the odometry be worse than it says, frames tell them from the others
/// before the belief is left behind.
void Tracker::Step::doubt_odometry() {
  if (!settings_.recovers || coasts() || !wind().is_none()) return;
  filter_.try_drifts(kTriedShare, kFoundWindShare * speed_m_s());
}

AcceptanceRegion Tracker::Step::region() const {
  AcceptanceRegion region = tracker_.region_;
  region.drift_sigma_m_s = wind().sigma_m_s;
  if (coasts()) region.drift_sigma_m_s = std::max(region.drift_sigma_m_s, speed_m_s());
  return region;
}

/// False where the belief left the region and began anew.
bool Tracker::Step::predict_motion() {
  const VehicleNoise& vehicle = settings_.vehicle;
  const double wind_walk = wind().walk;
  const bool coasted = std::exchange(state_.coasts, coasts());
  if (input_.odometry) {
    const OdometryCovariance told = input_.covariance ? *input_.covariance : covariance_of(*input_.odometry, vehicle);
    const auto [odometry, covariance] =
        with_lost_steps(*input_.odometry, told, static_cast<double>(estimate_.missed_steps));
    const OdometryMotion motion(odometry, covariance, seconds(), wind_walk);
    carry_frames_on(*input_.odometry, told);
    state_.velocity = {odometry.forward_m / seconds(), odometry.right_m / seconds()};
    if (!coasted) return predict(motion);
    return predict([&motion, region = region()](ParticleState& state, RandomStream& random) {
      draw_drift(region, state, random);
      motion(state, random);
    });
  }
  state_.recent.clear();
  if (vehicle.planar) {
    return predict(PlanarMotion{vehicle.planar->speed_m_s, vehicle.planar->turn_rate_rad_s, seconds(), wind_walk});
  }
  return coast(!coasted);
}

bool Tracker::Step::coasts() const { return !input_.odometry && !settings_.vehicle.planar; }

/// On with the velocity that odometry told, if any did.
bool Tracker::Step::coast(bool begins) {
  ConstantVelocityMotion motion{seconds()};
  motion.velocity_walk = std::max(kLeastManoeuvreMS, kManoeuvreShare * speed_m_s());
  if (begins) motion.joins = state_.velocity.value_or(BodyVelocity{});
  return predict(motion);
}

/// Only where the odometry tells how the ground below goes on, and the frames how large it is.
void Tracker::Step::carry_frames_on(const Odometry& odometry, const OdometryCovariance& covariance) {
  if (!wind().is_none() || settings_.vehicle.scale_range > 0.0 || estimate_.missed_steps > 0) {
    state_.recent.clear();
  } else {
    state_.recent.move(odometry, covariance);
  }
}

void Tracker::Step::forget_support() {
  state_.claim = {};
  state_.searched = false;
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
