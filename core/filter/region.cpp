#include "core/filter/region.hpp"

namespace roadfix {
namespace {

/// The part of the box that a circle can reach.
GridBox clipped(const GridBox& box, const GridCircle& circle) {
  return intersection(box, grown({circle.centre, circle.centre}, circle.radius_m));
}

}  // namespace

bool AcceptanceRegion::keeps(GridPoint point) const { return poses.grown(beyond_m, Angle()).contains(point); }

ParticleState uniform_draw(const AcceptanceRegion& region, const PoseRegion& poses, RandomStream& random) {
  const GridBox within = poses.circle ? clipped(poses.box, *poses.circle) : poses.box;
  ParticleState state;
  constexpr int kMaxTries = 1000;  // a circle that only grazes the box
  for (int i = 0; i < kMaxTries; ++i) {
    state.east_m = random.uniform(within.min.east_m, within.max.east_m);
    state.north_m = random.uniform(within.min.north_m, within.max.north_m);
    if (poses.contains(GridPoint{state.east_m, state.north_m})) break;
  }
  const double half_rad = poses.heading_half_width.radians();
  state.heading_rad = (poses.heading + Angle::radians(random.uniform(-half_rad, half_rad))).wrapped().radians();
  state.log_scale = random.uniform(-region.max_log_scale, region.max_log_scale);
  draw_drift(region, state, random);
  return state;
}

void draw_drift(const AcceptanceRegion& region, ParticleState& state, RandomStream& random) {
  state.drift_east_m_s = state.drift_north_m_s = 0.0;
  if (region.drift_sigma_m_s == 0.0) return;
  state.drift_east_m_s = region.drift_sigma_m_s * random.normal();
  state.drift_north_m_s = region.drift_sigma_m_s * random.normal();
}

}  // namespace roadfix
