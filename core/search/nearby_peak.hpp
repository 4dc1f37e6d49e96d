// Where a feature map fits once more a little beside a place: a map that holds each street twice, or a road along which
// the frame slides from one junction to the next.
#pragma once

#include <optional>

#include "core/match/lattice_pose.hpp"
#include "core/search/level.hpp"

namespace roadfix {

/// The best other peak of the scores up to `apart_m` from a place, at its heading and scale, in steps of less than a
/// road is wide. nullopt where scores only fall.
std::optional<LatticePose> nearby_peak(const Level& level, const LatticePose& place, double apart_m);

}  // namespace roadfix
