// A second peak close to a place: on a map that shows each street twice, or along a road where the frame fits at one
// junction and at the next.
#pragma once

#include <optional>

#include "core/match/lattice_pose.hpp"
#include "core/search/level.hpp"

namespace roadfix {

/// The best other peak of the scores within `apart_m` of the place, at its heading and scale, in steps smaller than
/// roads are wide. nullopt if there is none.
std::optional<LatticePose> nearby_peak(const Level& level, const LatticePose& place, double apart_m);

}  // namespace roadfix
