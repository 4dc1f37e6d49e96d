#include "core/filter/region.hpp"

namespace roadfix {
namespace {

/// The part of the box that a circle can reach.
GridBox clipped(const GridBox& box, const GridCircle& circle) {
  return intersection(box, grown({circle.centre, circle.centre}, circle.radius_m));
}

}  // namespace

bool AcceptanceRegion::keeps(GridPoint point) const { return poses.grown(beyond_m, Angle()).contains(point); }

ParticleState uniform_draw(const PoseRegion& region, RandomStream& random) {
  const GridBox within = region.circle ? clipped(region.box, *region.circle) : region.box;
  ParticleState state;
  constexpr int kMostTries = 1000;  // a circle that only grazes the box
  for (int i = 0; i < kMostTries; ++i) {
    state.east_m = random.uniform(within.min.east_m, within.max.east_m);
    state.north_m = random.uniform(within.min.north_m, within.max.north_m);
    if (region.contains({state.east_m, state.north_m})) break;
  }
  const double half_rad = region.heading_half_width.radians();
  state.heading_rad = (region.heading + Angle::radians(random.uniform(-half_rad, half_rad))).wrapped().radians();
  return state;
}

}  // namespace roadfix
