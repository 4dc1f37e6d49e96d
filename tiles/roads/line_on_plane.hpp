// Lines of a file on the plane of a zone.
#pragma once

#include <ogrsf_frmts.h>

#include <optional>
#include <vector>

#include "core/units/planar.hpp"

namespace roadfix {

/// Corners of the line, and points between those that lie more than `longest_m` apart: what is straight in the
/// reference system of a file, where programs draw it, is curved on the plane. Of two degrees along a parallel the
/// middle is some hundred metres off the chord; of 2 km it is 0.2 m, at latitude 70. Across the antimeridian the
/// shorter way is taken. nullopt where a corner has no place on the plane.
std::optional<std::vector<GridPoint>> line_on_plane(const OGRSimpleCurve& line, OGRCoordinateTransformation& to_plane,
                                                    double longest_m);

}  // namespace roadfix
