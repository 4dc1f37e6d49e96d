// Web-Mercator ends at 180 degrees: what lies on both sides of it is as wide as the Earth there.
#pragma once

#include "core/geodesy/utm.hpp"
#include "core/grid/geometry.hpp"

namespace roadfix {

/// Throws InvalidInput "region-across-antimeridian" where the region lies on both sides; its text has the --bbox of
/// either side, and the width of the strip between them, which is as wide as the meridian of 180 degrees leans across
/// the region.
void require_one_side(const UtmZone& zone, const GridGeometry& region);

}  // namespace roadfix
