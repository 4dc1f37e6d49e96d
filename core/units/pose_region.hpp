// Where on the plane a vehicle may be, and where it may be heading.
#pragma once

#include <optional>
#include <vector>

#include "core/units/grid_quad.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

struct PoseRegion {
  GridBox box;
  std::optional<GridCircle> circle;  ///< intersects the box
  Angle heading;                     ///< centre of the range, from grid north
  Angle heading_half_width = Angle::degrees(180.0);
  /// The position lies in one of them, where there are any. They intersect the box.
  std::vector<GridQuad> quads{};

  bool contains(GridPoint point) const;
  bool contains(Angle grid_heading) const;
  bool contains(const GridPose& pose) const { return contains(pose.position) && contains(pose.heading); }
  /// The area of the box, of what the quads hold of it (to some percent) or of the circle, whichever is least.
  double area_km2() const;
  PoseRegion grown(double by_m, Angle by_heading) const;
};

}  // namespace roadfix
