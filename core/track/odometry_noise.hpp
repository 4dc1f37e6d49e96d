// How uncertain the odometry of a step is if the vehicle does not say so.
#pragma once

#include <utility>

#include "core/filter/motion.hpp"
#include "core/track/track_settings.hpp"

namespace roadfix {

/// Covariance of (forward m, right m, turn rad) of a step of so many seconds: sigmas are a share of what was travelled,
/// as `noise` says, and a little that grows with the root of the seconds beyond the first. A minute in one step is
/// about as uncertain as in sixty. `unseen_m`: what was travelled before without a frame. All of that errs by the same
/// share, as by a wrong scale, so that it is the sigmas of its steps that add up, not their variances.
OdometryCovariance covariance_of(const Odometry& odometry, double seconds, const VehicleNoise& noise,
                                 double unseen_m = 0.0);

/// The odometry of a step together with `lost` unknown steps before it, which are taken to have been like it, give or
/// take half of it (1 sigma).
std::pair<Odometry, OdometryCovariance> with_lost_steps(const Odometry& odometry, OdometryCovariance covariance,
                                                        double lost);

}  // namespace roadfix
