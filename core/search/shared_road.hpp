// How much road an agreement rests on.
#pragma once

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// Assumed of streets; in larger cells a road is as wide as a cell.
inline constexpr double kRoadWidthM = 6.0;

/// Of the roads that make map and features correlate, the length in cells that lies beside so many of the longest
/// straight lines among them. A cell counts as its side over the width of the road there, but at least `narrowest`
/// cells: wide roads are no longer than narrow ones, and what is left of one that is seen beside itself is no longer
/// than all of it. How sure a detector is does not matter. A line takes in what lies within a stripe of `line_width`
/// cells. Map and features are of the same size.
double road_beside_lines(const CellArray& map, const CellArray& features, int lines, double narrowest,
                         double line_width);

}  // namespace roadfix
