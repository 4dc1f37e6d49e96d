// How far the scores of poses spread by chance, told from some of them.
#pragma once

#include <optional>

#include "core/match/deadline.hpp"
#include "core/search/level.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

/// Root of the mean square of the scores of poses all over a region, as the feature map was given in size: of a level
/// that is too fine to be scanned. nullopt where too few of them have a score, or time was over before.
std::optional<double> score_spread(const Level& level, const PoseRegion& region, const Deadline& deadline);

}  // namespace roadfix
