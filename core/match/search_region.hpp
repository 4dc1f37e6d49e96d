// Where a search looks: positions and headings.
#pragma once

#include <optional>

#include "core/grid/geometry.hpp"

namespace roadfix {

/// Grid positions of the nadir and grid headings to consider.
struct SearchRegion {
  GridBox box;
  std::optional<GridCircle> circle;  ///< intersects the box
  Angle heading;                     ///< centre of the range
  Angle heading_half_width = Angle::degrees(180.0);

  bool contains(GridPoint point) const;
  bool contains(Angle grid_heading) const;
  double area_km2() const;
  SearchRegion grown(double by_m, Angle heading) const;
};

}  // namespace roadfix
