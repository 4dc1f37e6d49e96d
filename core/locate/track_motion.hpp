// How uncertain the odometry of a step is where the vehicle does not say it.
#pragma once

#include <utility>

#include "core/filter/motion.hpp"
#include "core/locate/tracker.hpp"

namespace roadfix {

/// A share of what was travelled, and at least a little.
OdometryCovariance covariance_of(const Odometry& odometry, const VehicleNoise& noise);

/// The steps that were lost are taken to have been like this one, give or take half of it.
std::pair<Odometry, OdometryCovariance> with_lost_steps(const Odometry& odometry, OdometryCovariance covariance,
                                                        double lost);

}  // namespace roadfix
