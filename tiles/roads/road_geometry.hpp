// The lines of a feature on the plane of a zone.
#pragma once

#include <ogrsf_frmts.h>

#include "tiles/roads/road_lines.hpp"

namespace roadfix {

/// Whether a line is among the parts of the geometry, however deep they are nested. One that ends where it begins and
/// goes nowhere is a point.
bool holds_a_line(const OGRGeometry& geometry);

/// How the lines of a feature are drawn.
struct Drawing {
  double width_m = 0.0;
  std::size_t road_class = 0;
};

/// Adds every line of the geometry to `network`, however deep it is nested, and curves as straight pieces. False when
/// it has none that could be placed.
bool add_geometry(const OGRGeometry& geometry, OGRCoordinateTransformation& to_plane, const Drawing& drawing,
                  RoadNetwork& network);

}  // namespace roadfix
