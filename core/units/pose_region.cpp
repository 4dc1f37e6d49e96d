#include "core/units/pose_region.hpp"

#include <algorithm>
#include <numbers>

namespace roadfix {
namespace {

bool in_one_of(const std::vector<GridQuad>& quads, GridPoint point) {
  return std::ranges::any_of(quads, [&](const GridQuad& quad) { return quad.contains(point); });
}

/// Of the box, as far as points tell that are spread over it.
double share_within(const std::vector<GridQuad>& quads, const GridBox& box) {
  constexpr int kAcross = 64;
  int within = 0;
  for (int row = 0; row < kAcross; ++row) {
    for (int col = 0; col < kAcross; ++col) {
      within += in_one_of(quads, {box.min.east_m + box.width_m() * (col + 0.5) / kAcross,
                                  box.min.north_m + box.height_m() * (row + 0.5) / kAcross});
    }
  }
  return std::max(1, within) / static_cast<double>(kAcross * kAcross);
}

}  // namespace

bool PoseRegion::contains(GridPoint point) const {
  return box.contains(point) && (!circle || roadfix::contains(*circle, point)) &&
         (quads.empty() || in_one_of(quads, point));
}

bool PoseRegion::contains(Angle grid_heading) const {
  return heading_half_width.radians() >= std::numbers::pi ||
         angular_distance(grid_heading, heading) <= heading_half_width;
}

double PoseRegion::area_km2() const {
  double boxed = box.empty() ? 0.0 : box.width_m() * box.height_m() * 1e-6;
  if (!quads.empty()) boxed *= share_within(quads, box);
  if (!circle) return boxed;
  return std::min(boxed, std::numbers::pi * circle->radius_m * circle->radius_m * 1e-6);
}

PoseRegion PoseRegion::grown(double by_m, Angle by_heading) const {
  PoseRegion result = *this;
  result.box = roadfix::grown(box, by_m);
  if (result.circle) result.circle->radius_m += by_m;
  for (GridQuad& quad : result.quads) quad = quad.grown(by_m);
  result.heading_half_width += by_heading;
  return result;
}

}  // namespace roadfix
