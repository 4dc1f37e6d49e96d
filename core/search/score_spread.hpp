// How widely the scores of poses spread by chance, estimated from a sample.
#pragma once

#include <optional>

#include "core/match/deadline.hpp"
#include "core/search/level.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

/// Root mean square of the scores of poses all over a region, at scale 1, on a level that is too fine to be scanned.
/// nullopt where too few of them have a score, or time ran out.
std::optional<double> score_spread(const Level& level, const PoseRegion& region, const Deadline& deadline);

}  // namespace roadfix
