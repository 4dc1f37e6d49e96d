// Is a pose as uncertain as it says? The normalised estimation error squared (NEES) is distributed as chi^2 where it
// is, of a position with two degrees of freedom, of a heading with one.
#pragma once

#include <algorithm>

#include "core/locate/ellipse.hpp"

namespace roadfix::evaluation {

/// 95 % of chi^2 with two degrees of freedom lie below.
inline constexpr double kChiSquare95 = 5.991;
/// The same with one degree of freedom.
inline constexpr double kChiSquare95OfHeading = 3.841;

/// `ellipse` is on_grid().
inline double nees(GridPoint centre, const Ellipse& ellipse, GridPoint truth) {
  constexpr double kMinSigmaM = 1e-3;
  const double east = truth.east_m - centre.east_m;
  const double north = truth.north_m - centre.north_m;
  const double s = sin(ellipse.heading);
  const double c = cos(ellipse.heading);
  const double along = (east * s + north * c) / std::max(ellipse.sigma_m[0], kMinSigmaM);
  const double across = (east * c - north * s) / std::max(ellipse.sigma_m[1], kMinSigmaM);
  return along * along + across * across;
}

inline double heading_nees(Angle heading, Angle sigma, Angle truth) {
  constexpr double kMinSigmaRad = 1e-6;
  const double off = angular_distance(heading, truth).radians() / std::max(sigma.radians(), kMinSigmaRad);
  return off * off;
}

}  // namespace roadfix::evaluation
