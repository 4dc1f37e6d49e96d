#include "core/track/track_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/track/odometry_noise.hpp"

namespace roadfix {
namespace {

// The altitude's error wanders by this share of its range per square root of a second, with the relief below and the
// air pressure.
constexpr double kScaleWalkShare = 0.03;

// Without odometry the velocity may change by this share of the speed within a second, and by at least so many m/s
// (1 sigma per axis). A turn of 15 degrees a second changes it by a quarter; a copter that hovered sets off as fast.
constexpr double kManoeuvreShare = 0.5;
constexpr double kLeastManoeuvreMS = 3.0;
// It goes on turning for some seconds, or may have stopped: 1 sigma as a share of the turn.
constexpr double kTurnLastsS = 3.0;
constexpr double kTurnDoubt = 0.5;

// At most: of a vehicle whose odometry is not told, the speed that is told for it, and the wind.
constexpr double kStraySpeeds = 2.0;
constexpr double kStrayMS2 = 10.0;  // by which it changes its velocity
constexpr double kSpeedSigmas = 2.0;
constexpr double kWindSigmas = 2.0;

// 1 sigma per axis of the wind that is learned once the odometry was found to be wrong, unless a stronger one was told.
constexpr double kFoundWindShare = 0.3;
constexpr double kLeastFoundWindMS = 5.0;
constexpr double kShortestS = 0.01;  // times are not accurate enough to tell the velocity of a shorter step
constexpr double kTriedShare = 0.1;  // of the particles, that try other drifts while the odometry seems right

BodyVelocity velocity_at_end(const Odometry& odometry, double seconds) {
  const BodyOffset back = offset_from(moved({}, odometry), {});
  return {-back.forward_m / seconds, -back.right_m / seconds};
}

bool repeats(const ToldMotion& told, const LearnedMotion& before) {
  constexpr double kLeastM = 1.0;   // a slower vehicle is not far from where it was
  constexpr double kSameM = 0.002;  // clients round to a millimetre, and a thousandth of a degree
  constexpr double kSameDeg = 0.002;
  if (!told.odometry || !before.velocity || distance_m(*told.odometry) < kLeastM || told.seconds < kShortestS) {
    return false;
  }
  const BodyVelocity velocity = velocity_at_end(*told.odometry, told.seconds);
  const Angle turn = told.odometry->turn - Angle::radians(told.seconds * before.turn_rate_rad_s);
  return told.seconds * std::abs(velocity.forward_m_s - before.velocity->forward_m_s) <= kSameM &&
         told.seconds * std::abs(velocity.right_m_s - before.velocity->right_m_s) <= kSameM &&
         std::abs(turn.degrees()) <= kSameDeg;
}

}  // namespace

StepMotion::StepMotion(const VehicleNoise& vehicle, const AcceptanceRegion& flight, const ToldMotion& told,
                       const LearnedMotion& before)
    : vehicle_(vehicle), flight_(flight), told_(told), learned_(before) {
  if (before.unseen_m > 0.0 && repeats(told, before)) told_.odometry.reset();
}

OdometryCovariance StepMotion::odometry_covariance() const { return covariance_after(0.0); }

OdometryCovariance StepMotion::covariance_after(double unseen_m) const {
  if (told_.covariance) return *told_.covariance;
  return covariance_of(*told_.odometry, told_.seconds / static_cast<double>(1 + told_.lost_steps), vehicle_, unseen_m);
}

bool StepMotion::odometry_is_complete() const { return wind().is_none() && told_.lost_steps == 0; }

double StepMotion::speed_m_s() const {
  if (learned_.velocity) return std::hypot(learned_.velocity->forward_m_s, learned_.velocity->right_m_s);
  return vehicle_.planar ? std::abs(vehicle_.planar->speed_m_s.mean) : 0.0;
}

double StepMotion::travelled_m() const {
  if (!told_.odometry) return speed_m_s() * told_.seconds;
  return distance_m(*told_.odometry) * static_cast<double>(1 + told_.lost_steps);
}

Wind StepMotion::wind() const {
  const Wind& told = vehicle_.wind;
  if (!learned_.odometry_is_wrong) return told;
  return {std::max({told.sigma_m_s, kLeastFoundWindMS, kFoundWindShare * speed_m_s()})};
}

AcceptanceRegion StepMotion::region() const {
  AcceptanceRegion region = flight_;
  region.drift_sigma_m_s = wind().sigma_m_s;
  if (coasts()) region.drift_sigma_m_s = std::max(region.drift_sigma_m_s, speed_m_s());
  return region;
}

double StepMotion::move(Filter& filter) {
  const bool coasted = std::exchange(learned_.coasts, coasts());
  if (told_.odometry) return follow_odometry(filter, coasted);
  learned_.unseen_m += travelled_m();
  return vehicle_.planar ? follow_speed(filter, *vehicle_.planar) : coast(filter, !coasted);
}

void StepMotion::carry(Reach& reach) const {
  if (!told_.odometry) return reach.stray(strays_by_m());
  const auto [odometry, covariance] =
      with_lost_steps(*told_.odometry, odometry_covariance(), static_cast<double>(told_.lost_steps));
  reach.move(odometry, covariance, kWindSigmas * wind().sigma_m_s * told_.seconds);
}

double StepMotion::strays_by_m() const {
  if (vehicle_.planar) {
    const auto [mean, sigma] = vehicle_.planar->speed_m_s;
    return told_.seconds * (kStraySpeeds * std::abs(mean) + kSpeedSigmas * sigma + kWindSigmas * wind().sigma_m_s);
  }
  if (!learned_.velocity) return std::numeric_limits<double>::infinity();
  const auto faster_by_m = [](double seconds) { return 0.5 * kStrayMS2 * seconds * seconds; };
  return kStraySpeeds * travelled_m() + faster_by_m(learned_.coasted_s + told_.seconds) -
         faster_by_m(learned_.coasted_s);
}

void StepMotion::begin_anew() { learned_ = {std::nullopt, 0.0, learned_.odometry_is_wrong, coasts()}; }

/// If the step before told no motion, the drift of the particles was their whole velocity: they draw a new one.
double StepMotion::follow_odometry(Filter& filter, bool coasted) {
  const auto [odometry, covariance] =
      with_lost_steps(*told_.odometry, covariance_after(learned_.unseen_m), static_cast<double>(told_.lost_steps));
  const OdometryMotion motion(odometry, covariance, told_.seconds, wind().walk());
  learned_.unseen_m += travelled_m();
  learned_.coasted_s = 0.0;
  if (told_.seconds >= kShortestS) learn_velocity(odometry);
  if (!coasted) return predict(filter, motion);
  return predict(filter, [&motion, region = region()](ParticleState& state, RandomStream& random) {
    draw_drift(region, state, random);
    motion(state, random);
  });
}

/// Speed and turn rate err alike in all steps, so that it is the sigmas of those without a frame that add up, not their
/// variances.
double StepMotion::follow_speed(Filter& filter, const VehicleNoise::Planar& planar) {
  const double grown = std::sqrt(1.0 + 2.0 * learned_.unseen_s / told_.seconds);
  const Gaussian speed{planar.speed_m_s.mean, grown * planar.speed_m_s.sigma};
  const Gaussian turn_rate{planar.turn_rate_rad_s.mean, grown * planar.turn_rate_rad_s.sigma};
  learned_.unseen_s += told_.seconds;
  return predict(filter, PlanarMotion{speed, turn_rate, told_.seconds, wind().walk()});
}

void StepMotion::learn_velocity(const Odometry& odometry) {
  learned_.velocity = velocity_at_end(odometry, told_.seconds);
  learned_.turn_rate_rad_s = odometry.turn.radians() / told_.seconds;
}

/// Of this step. The variances of steps add up to that of the whole turn.
Gaussian StepMotion::turn_goes_on() const {
  const auto turned_by = [&](double seconds) {
    return -learned_.turn_rate_rad_s * kTurnLastsS * std::expm1(-seconds / kTurnLastsS);
  };
  const double before = turned_by(learned_.coasted_s);
  const double after = turned_by(learned_.coasted_s + told_.seconds);
  return {after - before, kTurnDoubt * std::sqrt(after * after - before * before)};
}

/// On with the velocity and turn rate of the last odometry, if there was any.
double StepMotion::coast(Filter& filter, bool begins) {
  ConstantVelocityMotion motion{told_.seconds};
  motion.velocity_walk = std::max(kLeastManoeuvreMS, kManoeuvreShare * speed_m_s());
  motion.turn_rad = turn_goes_on();
  learned_.coasted_s += told_.seconds;
  if (begins) motion.joins = learned_.velocity.value_or(BodyVelocity{});
  return predict(filter, motion);
}

template <MotionModel Motion>
double StepMotion::predict(Filter& filter, const Motion& motion) const {
  const double range = vehicle_.scale_range;
  if (range == 0.0) return filter.predict(motion);
  const ScaleWalk scale_walk{told_.seconds, kScaleWalkShare * range, flight_.max_log_scale};
  return filter.predict([&](ParticleState& state, RandomStream& random) {
    motion(state, random);
    scale_walk(state, random);
  });
}

void StepMotion::try_drifts(Filter& filter) const {
  if (!coasts() && wind().is_none()) filter.try_drifts(kTriedShare, kFoundWindShare * speed_m_s());
}

void StepMotion::learn_drift(Filter& filter) {
  if (learned_.odometry_is_wrong || coasts()) return;
  learned_.odometry_is_wrong = true;
  filter.widen_drift(wind().sigma_m_s);
}

}  // namespace roadfix
