// The vehicle's true motion, by equation (4), and what its odometry says of it.
#pragma once

#include "cli/evaluation/random.hpp"
#include "cli/fly/pilot.hpp"
#include "core/filter/motion.hpp"

namespace roadfix::fly {

/// 1 sigma each. The errors of the first two are drawn in every step, the others once for the flight.
struct OdometryErrors {
  double share = 0.03;                      ///< of the distance, per axis
  Angle turn = Angle::degrees(0.3);         ///< of a step's turn
  double scale = 0.02;                      ///< of all distances: altitude or calibration is off
  Angle turn_drift = Angle::degrees(0.05);  ///< per second
  double wind_m_s = 0.0;                    ///< per axis: it is relative to the air
};

/// Of one flight: what it draws once is drawn when it is made.
class OdometrySensor {
 public:
  OdometrySensor(const OdometryErrors& errors, evaluation::Random& random);

  /// What it says of a motion through the air of that length and duration.
  Odometry measure(const Odometry& moved, double length_m, double seconds, evaluation::Random& random) const;
  /// Where the wind, which it does not feel, carries a vehicle in that time.
  GridPose drifted(const GridPose& pose, double seconds) const;

 private:
  OdometryErrors errors_;
  double scale_;
  Angle turn_drift_;
  GridPoint wind_m_s_;  ///< velocity of the air over the ground
};

class Vehicle {
 public:
  Vehicle(const GridPose& start, const Handling& handling, const OdometryErrors& errors, evaluation::Random& random);

  const GridPose& pose() const { return pose_; }
  /// Somewhere else without its odometry noticing.
  void jump_to(const GridPose& pose) { pose_ = pose; }

  /// Follows an arc with this turn for one step; returns what the odometry says.
  Odometry move(Angle turn, evaluation::Random& random);

 private:
  GridPose pose_;
  Handling handling_;
  OdometrySensor odometry_;
};

}  // namespace roadfix::fly
