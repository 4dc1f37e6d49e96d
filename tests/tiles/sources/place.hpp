// Where the sources of tests lie.
#pragma once

#include "core/geodesy/utm.hpp"

namespace roadfix::testing {

inline const UtmZone kZone = *UtmZone::from_epsg(32637);
inline constexpr GridPoint kCentre{400000.0, 4200000.0};

}  // namespace roadfix::testing
