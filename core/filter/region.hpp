// Where particles may live (the paper's acceptance region), and where new ones are drawn uniformly.
#pragma once

#include "core/filter/particles.hpp"
#include "core/filter/random.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

struct AcceptanceRegion {
  PoseRegion poses;       ///< where new ones are drawn
  double beyond_m = 0.0;  ///< so far outside particles live on

  /// Whether a particle that has come there lives on.
  bool keeps(GridPoint point) const;
};

/// Uniform over the region and its headings, without drift. Its box is not empty, and meets the circle in more than a
/// point.
ParticleState uniform_draw(const PoseRegion& region, RandomStream& random);

}  // namespace roadfix
