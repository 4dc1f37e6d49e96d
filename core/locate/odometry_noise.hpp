// How uncertain the odometry of a step is where the vehicle does not say it.
#pragma once

#include <utility>

#include "core/filter/motion.hpp"
#include "core/locate/track_settings.hpp"

namespace roadfix {

/// Covariance of (forward m, right m, turn rad): sigmas are a share of what was travelled, and at least a little, as
/// `noise` says.
OdometryCovariance covariance_of(const Odometry& odometry, const VehicleNoise& noise);

/// The odometry of a step and of `lost` steps before it, of which nothing is known: they are taken to have been like
/// this one, give or take half of it (1 sigma).
std::pair<Odometry, OdometryCovariance> with_lost_steps(const Odometry& odometry, OdometryCovariance covariance,
                                                        double lost);

}  // namespace roadfix
