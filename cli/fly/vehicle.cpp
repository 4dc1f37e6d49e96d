#include "cli/fly/vehicle.hpp"

#include <cmath>

namespace roadfix::fly {
namespace {

/// Body-frame displacement along an arc of this length and turn.
Odometry arc(double length_m, Angle turn) {
  constexpr double kStraight = 1e-9;
  const double angle = turn.radians();
  if (std::abs(angle) < kStraight) return {length_m, 0.0, turn};
  const double radius = length_m / angle;
  return {radius * std::sin(angle), radius * (1.0 - std::cos(angle)), turn};
}

}  // namespace

OdometrySensor::OdometrySensor(const OdometryErrors& errors, evaluation::Random& random)
    : errors_(errors), scale_(1.0 + errors.scale * normal(random)), turn_drift_(normal(random) * errors.turn_drift) {
  if (errors.wind_m_s > 0.0) wind_m_s_ = {errors.wind_m_s * normal(random), errors.wind_m_s * normal(random)};
}

Odometry OdometrySensor::measure(const Odometry& moved, double length_m, double seconds,
                                 evaluation::Random& random) const {
  const double spread = errors_.share * length_m;
  return {scale_ * moved.forward_m + spread * normal(random), scale_ * moved.right_m + spread * normal(random),
          (moved.turn + seconds * turn_drift_ + normal(random) * errors_.turn).wrapped()};
}

GridPose OdometrySensor::drifted(const GridPose& pose, double seconds) const {
  return {{pose.position.east_m + seconds * wind_m_s_.east_m, pose.position.north_m + seconds * wind_m_s_.north_m},
          pose.heading};
}

Vehicle::Vehicle(const GridPose& start, const Handling& handling, const OdometryErrors& errors,
                 evaluation::Random& random)
    : pose_(start), handling_(handling), odometry_(errors, random) {}

Odometry Vehicle::move(Angle turn, evaluation::Random& random) {
  const double length_m = handling_.speed_m_s * handling_.step_s;
  const Odometry step = arc(length_m, turn);
  pose_ = odometry_.drifted(moved(pose_, step), handling_.step_s);
  return odometry_.measure(step, length_m, handling_.step_s, random);
}

}  // namespace roadfix::fly
