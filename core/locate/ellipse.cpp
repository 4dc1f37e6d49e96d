#include "core/locate/ellipse.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

Ellipse ellipse_of(const PositionCovariance& c) {
  const double mean = 0.5 * (c.east2 + c.north2);
  const double split = std::hypot(0.5 * (c.north2 - c.east2), c.east_north);
  const double along_north = 0.5 * std::atan2(2.0 * c.east_north, c.north2 - c.east2);
  return {{std::sqrt(mean + split), std::sqrt(std::max(0.0, mean - split))}, Angle::radians(along_north)};
}

}  // namespace roadfix
