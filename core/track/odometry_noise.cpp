#include "core/track/odometry_noise.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

OdometryCovariance covariance_of(const Odometry& odometry, double seconds, const VehicleNoise& noise, double unseen_m) {
  constexpr double kLeastM = 0.3;  // of a step of a second or less
  constexpr Angle kLeastTurn = Angle::degrees(0.5);
  const double walked = std::sqrt(std::max(1.0, seconds));
  const double share_m = noise.odometry_share * distance_m(odometry);
  const double metres = walked * kLeastM + share_m;
  const double metres2 = metres * metres + 2.0 * share_m * noise.odometry_share * unseen_m;
  const double turn = walked * kLeastTurn.radians() + noise.odometry_share * std::abs(odometry.turn.radians());
  return {{{metres2, 0.0, 0.0}, {0.0, metres2, 0.0}, {0.0, 0.0, turn * turn}}};
}

namespace {

/// So many equal movements one after another: chords of one arc. The n-th has turned by n - 1 times the turn of one.
Odometry repeated(const Odometry& one, double times) {
  const double half_turn = 0.5 * one.turn.wrapped().radians();
  const double sine = std::sin(half_turn);
  const double length = std::abs(sine) < 1e-9 ? times : std::sin(times * half_turn) / sine;
  const GridPose along_chord{{}, Angle::radians((times - 1.0) * half_turn)};
  const GridPoint end = moved(along_chord, {length * one.forward_m, length * one.right_m, {}}).position;
  return {end.north_m, end.east_m, times * one.turn};
}

}  // namespace

std::pair<Odometry, OdometryCovariance> with_lost_steps(const Odometry& odometry, OdometryCovariance covariance,
                                                        double lost) {
  constexpr double kLostShare = 0.5;
  constexpr double kLostTurn = 0.3;
  const double metres = kLostShare * lost * distance_m(odometry);
  for (auto& row : covariance) {
    for (double& value : row) value *= 1.0 + lost;
  }
  covariance[0][0] += metres * metres;
  covariance[1][1] += metres * metres;
  covariance[2][2] += lost * kLostTurn * kLostTurn;
  return {repeated(odometry, 1.0 + lost), covariance};
}

}  // namespace roadfix
