// How uncertain a position on a map is, as an ellipse on the earth.
#pragma once

#include <array>

#include "core/geodesy/utm.hpp"

namespace roadfix {

struct MapView;

/// The ellipse of 95 % has axes of this many sigmas: the square root of the 0.95 quantile of chi^2 with two degrees of
/// freedom.
inline constexpr double kSigmasOf95 = 2.4477;

struct Ellipse {
  std::array<double, 2> sigma_m{};  ///< 1 sigma along the major and the minor axis
  Angle heading;                    ///< direction of the major axis, clockwise from true north, in [0, 180) degrees
};

/// The same with its heading from grid north.
Ellipse on_grid(const Ellipse& ellipse, const UtmZone& zone, GridPoint at);

/// With an error of another kind on both axes.
Ellipse widened(const Ellipse& ellipse, double sigma_m);

/// Of a position on a plane, m^2.
struct PositionCovariance {
  double east_east = 0.0;
  double east_north = 0.0;
  double north_north = 0.0;
};

/// `variances` (m^2) lie along the axis, which is clockwise from the plane's north, and across it.
PositionCovariance position_covariance(const std::array<double, 2>& variances, Angle axis);

/// Of a pose that a match placed at `at`: what the match alone leaves (m^2, rad^2), and the registration error of the
/// map's sources on both axes.
PositionCovariance position_covariance(const MapView& map, GridPoint at, const PoseCovariance& covariance);

/// Squared Mahalanobis distance of a point from a mean.
double squared_mahalanobis(GridPoint mean, GridPoint point, const PositionCovariance& covariance);

/// `at` is where the match placed the vehicle, `covariance` (m^2, rad^2) how uncertain the match alone leaves that. The
/// registration error of the map's sources is added to both axes.
Ellipse ellipse_of(const MapView& map, GridPoint at, const PoseCovariance& covariance);

}  // namespace roadfix
