// Poses of queries: uniform over place and heading, such that the whole footprint was seen by the imagery and by the
// map.
#pragma once

#include <functional>
#include <optional>

#include "cli/bench/manifest.hpp"
#include "cli/evaluation/random.hpp"
#include "core/units/planar.hpp"

namespace roadfix::bench {

using Observed = std::function<bool(GridPoint)>;

struct PoseSampling {
  GridBox region;  ///< where the footprint must lie entirely
  Footprint footprint;
  Observed observed;  ///< must hold on a 16 x 16 lattice of points over the footprint
};

/// Part of the box that remains after the excluded shares of its sides.
GridBox without(const GridBox& box, const Exclusion& exclude);

/// nullopt when 20,000 draws found no such pose.
std::optional<GridPose> draw_pose(const PoseSampling& sampling, evaluation::Random& random);

}  // namespace roadfix::bench
