#include "cli/fly/vehicle.hpp"

#include <cmath>
#include <numbers>

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

double normal(bench::Random& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - bench::uniform(random, 0.0, 1.0)));
  return radius * std::cos(bench::uniform(random, 0.0, 2.0 * std::numbers::pi));
}

Vehicle::Vehicle(const GridPose& start, const Handling& handling, const OdometryErrors& errors, bench::Random& random)
    : pose_(start),
      handling_(handling),
      errors_(errors),
      scale_(1.0 + errors.scale * normal(random)),
      turn_drift_(normal(random) * errors.turn_drift) {}

Odometry Vehicle::move(Angle turn, bench::Random& random) {
  const Odometry step = arc(handling_.speed_m_s * handling_.step_s, turn);
  pose_ = moved(pose_, step);
  const double spread = errors_.share * handling_.speed_m_s * handling_.step_s;
  return {scale_ * step.forward_m + spread * normal(random), scale_ * step.right_m + spread * normal(random),
          turn + handling_.step_s * turn_drift_ + normal(random) * errors_.turn};
}

}  // namespace roadfix::fly
