// The ground of a UTM zone that maps may cover: one lattice for every map of the zone.
#pragma once

#include "core/units/planar.hpp"

namespace roadfix {

inline constexpr GridBox kLattice{{0.0, 0.0}, {1 << 20, 10.0 * (1 << 20)}};

/// Ground of it that lies farther east has no latitude and longitude (see UtmZone).
inline constexpr double kEastmostM = 1e6;

}  // namespace roadfix
