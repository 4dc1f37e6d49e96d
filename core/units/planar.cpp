#include "core/units/planar.hpp"

#include <cmath>

namespace roadfix {

double distance_m(GridPoint a, GridPoint b) { return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m); }

}  // namespace roadfix
