// How far a vehicle can be from a place where it surely was: dead reckoning with bounds instead of a distribution, so
// that no agreement of frames by chance makes it narrower.
#pragma once

#include "core/filter/motion.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

struct Reach {
  /// Where it is wider, looks around a belief (track_look.hpp) do not cover it.
  static constexpr double kMaxM = 150.0;

  GridPoint position;
  Angle heading;
  double radius_m = 0.0;                             ///< the vehicle is not farther away from `position`
  Angle heading_half_width = Angle::degrees(180.0);  ///< of what was known at first
  double turn_rad2 = 0.0;                            ///< variance of the turns since then

  /// All of a region with a circle.
  static Reach within(const PoseRegion& region);
  /// Around a place where the vehicle was just found.
  static Reach around(const GridPose& found);

  /// By odometry of this covariance, and a drift that it does not feel of `drift_m` at most.
  void move(const Odometry& odometry, const OdometryCovariance& covariance, double drift_m);
  /// By so much, in whatever direction, turning by whatever angle.
  void stray(double by_m);
  bool is_lost() const { return radius_m > kMaxM; }
  /// Whether the vehicle may be where a belief has it, which errs by some metres itself.
  bool holds(const GridPose& believed) const;
  /// The vehicle's heading is not farther from `heading`.
  Angle turned_at_most() const;

  friend bool operator==(const Reach&, const Reach&) = default;
};

}  // namespace roadfix
