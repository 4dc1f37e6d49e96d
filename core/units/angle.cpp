#include "core/units/angle.hpp"

#include <cmath>

namespace roadfix {

Angle Angle::wrapped() const {
  const double turned = std::remainder(radians_, 2.0 * std::numbers::pi);
  return Angle(turned <= -std::numbers::pi ? turned + 2.0 * std::numbers::pi : turned);
}

double Angle::compass_degrees() const {
  const double turned = std::fmod(degrees(), 360.0);
  const double positive = turned < 0.0 ? turned + 360.0 : turned;
  return positive >= 360.0 ? 0.0 : positive;  // -1e-20 + 360 rounds to 360
}

Angle angular_distance(Angle a, Angle b) { return Angle::radians(std::abs((a - b).wrapped().radians())); }

double sin(Angle angle) { return std::sin(angle.radians()); }
double cos(Angle angle) { return std::cos(angle.radians()); }

}  // namespace roadfix
