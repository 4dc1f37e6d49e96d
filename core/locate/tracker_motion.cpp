// How the particles of a track move: by odometry, by equation (4), or as the vehicle flew before.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/locate/odometry_noise.hpp"
#include "core/locate/tracker_step.hpp"

namespace roadfix {
namespace {

// The altitude's error wanders by this share of its range per square root of a second, with the relief below and the
// air pressure.
constexpr double kScaleWalkShare = 0.03;

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

/// False where the belief left the region and began anew.
bool Tracker::Step::predict_motion() {
  const bool coasted = std::exchange(state_.coasts, coasts());
  if (input_.odometry) return follow_odometry(coasted);
  state_.recent.clear();
  const auto& planar = settings_.vehicle.planar;
  if (planar) return predict(PlanarMotion{planar->speed_m_s, planar->turn_rate_rad_s, seconds(), wind().walk});
  return coast(!coasted);
}

/// Where the step before told no motion, the drift of the particles was all of their velocity: they draw a new one.
bool Tracker::Step::follow_odometry(bool coasted) {
  const OdometryCovariance told =
      input_.covariance ? *input_.covariance : covariance_of(*input_.odometry, settings_.vehicle);
  const auto [odometry, covariance] =
      with_lost_steps(*input_.odometry, told, static_cast<double>(estimate_.missed_steps));
  const OdometryMotion motion(odometry, covariance, seconds(), wind().walk);
  carry_frames_on(*input_.odometry, told);
  state_.velocity = {odometry.forward_m / seconds(), odometry.right_m / seconds()};
  if (!coasted) return predict(motion);
  return predict([&motion, region = region()](ParticleState& state, RandomStream& random) {
    draw_drift(region, state, random);
    motion(state, random);
  });
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

/// Some particles try other velocities. Should the odometry be worse than it says, frames tell them from the others
/// before the belief is left behind.
void Tracker::Step::doubt_odometry() {
  if (!settings_.recovers || coasts() || !wind().is_none()) return;
  filter_.try_drifts(kTriedShare, kFoundWindShare * speed_m_s());
}

Wind Tracker::Step::wind() const {
  const Wind& told = settings_.vehicle.wind;
  if (!state_.drifts) return told;
  const Wind found = Wind::of(std::max(kLeastFoundWindMS, kFoundWindShare * speed_m_s()), std::nullopt);
  return {std::max(told.sigma_m_s, found.sigma_m_s), std::max(told.walk, found.walk)};
}

/// That the last odometry told; where none is to be expected, that of the vehicle.
double Tracker::Step::speed_m_s() const {
  if (state_.velocity) return std::hypot(state_.velocity->forward_m_s, state_.velocity->right_m_s);
  return settings_.vehicle.planar ? std::abs(settings_.vehicle.planar->speed_m_s.mean) : 0.0;
}

AcceptanceRegion Tracker::Step::region() const {
  AcceptanceRegion region = tracker_.region_;
  region.drift_sigma_m_s = wind().sigma_m_s;
  if (coasts()) region.drift_sigma_m_s = std::max(region.drift_sigma_m_s, speed_m_s());
  return region;
}

}  // namespace roadfix
