// The least squares behind a boresight, under one assumption of the signs of what is told.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "core/detect/boresight.hpp"
#include "core/detect/displacement.hpp"

namespace roadfix::boresight {

/// Of the mount (rad), of the height (ln of a factor), of the time (s), of the map (m).
enum Parameter { kYaw, kPitch, kRoll, kHigher, kDelay, kEast, kNorth, kParameters };
using Parameters = cv::Vec<double, kParameters>;
using Covariance = cv::Matx<double, kParameters, kParameters>;

/// 1, or -1 where roll or pitch is told with the wrong sign.
struct Signs {
  double roll = 1.0;
  double pitch = 1.0;
};

struct PlacedSighting {
  const BoresightSighting* seen;
  PlacedFrame placed;
};

/// For any number of fits, as long as the sightings live.
std::vector<PlacedSighting> placed_sightings(std::span<const BoresightSighting> sightings);

struct Fit {
  Signs signs;
  Parameters at = Parameters::all(0.0);
  Covariance covariance;
  std::vector<bool> used;      ///< by sighting: it does not lie elsewhere
  std::vector<double> left_m;  ///< by sighting: how far it is found from where these parameters have it
  double median_left_m() const;
};

/// Which sightings lie elsewhere, and how much the others scatter, follows from the fit, and the fit from these: a few
/// rounds of both. Arguments as those of boresight_of().
Fit fit_of(std::span<const PlacedSighting> sightings, const BoresightPrior& prior, const Signs& signs);

}  // namespace roadfix::boresight
