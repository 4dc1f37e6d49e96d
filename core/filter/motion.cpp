#include "core/filter/motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

double wrapped(double heading_rad) { return Angle::radians(heading_rad).wrapped().radians(); }

void drift(ParticleState& state, RandomStream& random, double seconds, double walk) {
  state.east_m += seconds * state.drift_east_m_s;
  state.north_m += seconds * state.drift_north_m_s;
  if (walk <= 0.0) return;
  const double sigma = walk * std::sqrt(seconds);
  state.drift_east_m_s += sigma * random.normal();
  state.drift_north_m_s += sigma * random.normal();
}

void require_finite(const Odometry& odometry, const OdometryCovariance& covariance) {
  bool finite =
      std::isfinite(odometry.forward_m) && std::isfinite(odometry.right_m) && std::isfinite(odometry.turn.radians());
  for (const auto& row : covariance)
    finite = finite && std::ranges::all_of(row, [](double x) { return std::isfinite(x); });
  if (!finite) {
    throw InvalidInput("odometry-not-finite",
                       "the odometry or its covariance holds a value that is no finite number: leave the step's "
                       "odometry out instead");
  }
}

}  // namespace

void PlanarMotion::operator()(ParticleState& state, RandomStream& random) const {
  const double speed = speed_m_s.mean + speed_m_s.sigma * random.normal();
  const double half_turn = 0.5 * seconds * (turn_rate_rad_s.mean + turn_rate_rad_s.sigma * random.normal());
  // (4) integrated: the chord of an arc points half the turn off the first heading.
  const double shrink = std::abs(half_turn) < 1e-6 ? 1.0 : std::sin(half_turn) / half_turn;
  const double chord = seconds * speed * shrink;
  const double direction = state.heading_rad + half_turn;
  state.east_m += chord * std::sin(direction);
  state.north_m += chord * std::cos(direction);
  state.heading_rad = wrapped(state.heading_rad + 2.0 * half_turn);
  drift(state, random, seconds, drift_walk);
}

OdometryMotion::OdometryMotion(const Odometry& odometry, const OdometryCovariance& covariance, double seconds,
                               double drift_walk)
    : mean_(odometry), seconds_(seconds), drift_walk_(drift_walk) {
  require_finite(odometry, covariance);
  const auto factor = cholesky(covariance);
  if (!factor) {
    throw InvalidInput("covariance-not-positive",
                       "the odometry's covariance is not symmetric and positive semi-definite: give the 3 x 3 "
                       "covariance of forward, right and turn");
  }
  factor_ = *factor;
}

void OdometryMotion::operator()(ParticleState& state, RandomStream& random) const {
  const double a = random.normal();
  const double b = random.normal();
  const double c = random.normal();
  const double forward = mean_.forward_m + factor_[0][0] * a;
  const double right = mean_.right_m + factor_[1][0] * a + factor_[1][1] * b;
  const double turn = mean_.turn.radians() + factor_[2][0] * a + factor_[2][1] * b + factor_[2][2] * c;
  const double sine = std::sin(state.heading_rad);
  const double cosine = std::cos(state.heading_rad);
  state.east_m += forward * sine + right * cosine;
  state.north_m += forward * cosine - right * sine;
  state.heading_rad = wrapped(state.heading_rad + turn);
  drift(state, random, seconds_, drift_walk_);
}

void ScaleWalk::operator()(ParticleState& state, RandomStream& random) const {
  const double sigma = walk * std::sqrt(seconds);
  state.log_scale = std::clamp(state.log_scale + sigma * random.normal(), -max_log_scale, max_log_scale);
}

void ConstantVelocityMotion::operator()(ParticleState& state, RandomStream& random) const {
  const double sine = std::sin(state.heading_rad);
  const double cosine = std::cos(state.heading_rad);
  state.drift_east_m_s += joins.forward_m_s * sine + joins.right_m_s * cosine;
  state.drift_north_m_s += joins.forward_m_s * cosine - joins.right_m_s * sine;
  // White acceleration, integrated over the step: what it does to the place, half of it follows from the velocity.
  const double walked = velocity_walk * std::sqrt(seconds);
  const auto go_on = [&](double& place_m, double& velocity_m_s) {
    const double change = walked * random.normal();
    place_m += seconds * (velocity_m_s + 0.5 * change + walked / std::sqrt(12.0) * random.normal());
    velocity_m_s += change;
  };
  go_on(state.east_m, state.drift_east_m_s);
  go_on(state.north_m, state.drift_north_m_s);
  const double heading_sigma = std::hypot(heading_walk_rad * std::sqrt(seconds), turn_rad.sigma);
  state.heading_rad = wrapped(state.heading_rad + turn_rad.mean + heading_sigma * random.normal());
}

}  // namespace roadfix
