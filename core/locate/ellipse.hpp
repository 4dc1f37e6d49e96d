// How uncertain a position on a map is, as an ellipse on the earth.
#pragma once

#include <array>

#include "core/locate/map_view.hpp"
#include "core/units/angle.hpp"

namespace roadfix {

/// So many sigmas along each axis hold 95 % of the positions: the square root of chi^2 with two degrees of freedom.
inline constexpr double kSigmasOf95 = 2.4477;

struct Ellipse {
  std::array<double, 2> sigma_m;  ///< along the major and minor axis
  Angle heading;                  ///< of the major axis, clockwise from true north, within [0, 180) degrees
};

/// `covariance` is that of the match alone at `at`. The registration error of the map's sources is added to both axes.
Ellipse ellipse_of(const MapView& map, GridPoint at, const PoseCovariance& covariance);

}  // namespace roadfix
