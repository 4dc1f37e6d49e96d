// How a particle moves in one step. A motion model is a small callable; any other with the same shape works.
#pragma once

#include <concepts>

#include "core/filter/cholesky.hpp"
#include "core/filter/particles.hpp"
#include "core/filter/random.hpp"
#include "core/units/angle.hpp"

namespace roadfix {

template <typename Model>
concept MotionModel = requires(const Model& model, ParticleState& state, RandomStream& random) {
  { model(state, random) } -> std::same_as<void>;
};

struct Gaussian {
  double mean = 0.0;
  double sigma = 0.0;
};

/// Equation (4) over `seconds`: v and w are drawn once for each particle and step and followed exactly, along an arc;
/// v = 0 turns on the spot. The paper counts psi from the x axis against the clock, here headings are clockwise from
/// north.
struct PlanarMotion {
  Gaussian speed_m_s;        ///< v
  Gaussian turn_rate_rad_s;  ///< w, clockwise
  double seconds = 0.0;
  double drift_walk = 0.0;  ///< growth of the drift's sigma per axis, m/s per square root of a second; 0 = no drift

  void operator()(ParticleState& state, RandomStream& random) const;
};

/// The pose after a step, seen from that before it. What a track is told turns the shorter way round, by 180 degrees at
/// most: noise and rates follow from the turn.
using Odometry = BodyOffset;

/// Covariance of (forward m, right m, turn rad).
using OdometryCovariance = Matrix3;

/// Odometry with Gaussian error, as visual-inertial odometry reports it.
class OdometryMotion {
 public:
  /// Throws InvalidInput ("odometry-not-finite", "covariance-not-positive") unless all is finite and the covariance is
  /// symmetric and positive semi-definite.
  OdometryMotion(const Odometry& odometry, const OdometryCovariance& covariance, double seconds = 0.0,
                 double drift_walk = 0.0);

  void operator()(ParticleState& state, RandomStream& random) const;

 private:
  Odometry mean_;
  OdometryCovariance factor_{};  ///< lower triangular, factor * factor^T = covariance
  double seconds_;
  double drift_walk_;
};

/// The error of the altitude wanders, and stays within its range.
struct ScaleWalk {
  double seconds = 0.0;
  double walk = 0.0;  ///< growth of the logarithm's sigma per square root of a second
  double max_log_scale = 0.0;

  void operator()(ParticleState& state, RandomStream& random) const;
};

/// Over the ground, ahead of a body and to its right.
struct BodyVelocity {
  double forward_m_s = 0.0;
  double right_m_s = 0.0;
  friend bool operator==(const BodyVelocity&, const BodyVelocity&) = default;
};

/// Nothing is told: the drift, which is all of the velocity then, goes on, changed by white acceleration, and the
/// heading turns and wanders.
struct ConstantVelocityMotion {
  double seconds = 0.0;
  double velocity_walk = 1.0;      ///< m/s per square root of a second and axis
  double heading_walk_rad = 0.05;  ///< per square root of a second
  Gaussian turn_rad{};             ///< of the step, clockwise; the velocity does not turn with it
  BodyVelocity joins{};            ///< the drift at first: what moved the particle beside it until now

  void operator()(ParticleState& state, RandomStream& random) const;
};

}  // namespace roadfix
