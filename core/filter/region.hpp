// Where particles may live (the paper's acceptance region), and where and how new ones are drawn.
#pragma once

#include "core/filter/particles.hpp"
#include "core/filter/random.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

struct AcceptanceRegion {
  PoseRegion poses;              ///< where new ones are drawn
  double beyond_m = 0.0;         ///< so far outside particles live on
  double max_log_scale = 0.0;    ///< their scale stays within +- that; 0 = it is as it was told
  double drift_sigma_m_s = 0.0;  ///< per axis, of the drift of new ones

  /// Whether a particle that has come there lives on.
  bool keeps(GridPoint point) const;
};

/// Uniform over `poses` and their headings, and over the logarithm of the scale; the drift is normal. The box of
/// `poses` is not empty, and meets the circle in more than a point.
ParticleState uniform_draw(const AcceptanceRegion& region, const PoseRegion& poses, RandomStream& random);

/// Gives the particle a drift as new ones have it, in place of its own.
void draw_drift(const AcceptanceRegion& region, ParticleState& state, RandomStream& random);

}  // namespace roadfix
