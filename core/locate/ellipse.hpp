// A covariance of position as an ellipse.
#pragma once

#include <array>

#include "core/units/angle.hpp"

namespace roadfix {

struct Ellipse {
  std::array<double, 2> sigma_m;  ///< along the major and minor axis
  Angle heading;                  ///< of the major axis, clockwise from grid north
};

struct PositionCovariance {
  double east2 = 0.0;
  double north2 = 0.0;
  double east_north = 0.0;
};

Ellipse ellipse_of(const PositionCovariance& covariance);

}  // namespace roadfix
