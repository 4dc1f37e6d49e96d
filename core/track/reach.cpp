#include "core/track/reach.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

const Angle kAnyHeading = Angle::degrees(180.0);
const Angle kKnownHeading = Angle::degrees(60.0);  // up to which a movement along it errs by less than its length

// What was just found: as far off as a track that is claimed there may be (is_same_place()).
constexpr double kFoundWithinM = 30.0;
const Angle kFoundHeading = Angle::degrees(6.0);

// Errors of positions add up, as if all had one cause; those of turns do not, as those of gyroscopes.
constexpr double kPositionSigmas = 2.0;
constexpr double kTurnSigmas = 3.0;

}  // namespace

Reach Reach::within(const PoseRegion& region) {
  return {region.circle->centre, region.heading, region.circle->radius_m, region.heading_half_width};
}

Reach Reach::around(const GridPose& found) { return {found.position, found.heading, kFoundWithinM, kFoundHeading}; }

void Reach::move(const Odometry& odometry, const OdometryCovariance& covariance, double drift_m) {
  const double length_m = distance_m(odometry);
  const double sigma_m = std::sqrt(largest_variance_m2(covariance));
  const Angle off = turned_at_most();
  const GridPose there = moved(GridPose{position, heading}, odometry);
  if (off <= kKnownHeading) {
    position = there.position;
    radius_m += 2.0 * length_m * std::sin(off.radians() / 2.0);
  } else {
    radius_m += length_m;
  }
  heading = there.heading;
  radius_m += kPositionSigmas * sigma_m + drift_m;
  turn_rad2 += covariance[2][2];
}

void Reach::stray(double by_m) {
  radius_m += by_m;
  heading_half_width = kAnyHeading;
}

bool Reach::holds(const GridPose& believed) const {
  constexpr double kBeliefM = 15.0;
  const Angle belief_heading = Angle::degrees(5.0);
  return distance_m(believed.position, position) <= radius_m + kBeliefM &&
         angular_distance(believed.heading, heading) <= turned_at_most() + belief_heading;
}

Angle Reach::turned_at_most() const {
  return std::min(heading_half_width + Angle::radians(kTurnSigmas * std::sqrt(turn_rad2)), kAnyHeading);
}

}  // namespace roadfix
