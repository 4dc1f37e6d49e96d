// How much road an agreement rests on.
#pragma once

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// Assumed of streets; in larger cells a road is as wide as a cell.
inline constexpr double kRoadWidthM = 6.0;

/// What counts as one straight road, in cells.
struct StraightRoad {
  double width;  ///< of the stripe that it may bend in
  double apart;  ///< of its two carriageways at most, from middle to middle
};

/// Of the roads that make map and features correlate, the length in cells that lies beside so many of the longest
/// straight roads among them. A cell counts as its side over the width of the road there, but at least `narrowest`
/// cells: wide roads are no longer than narrow ones, and what is left of one that is seen beside itself is no longer
/// than all of it. How sure a detector is does not matter. Map and features are of the same size.
double road_beside_straight_ones(const CellArray& map, const CellArray& features, int straight_roads,
                                 const StraightRoad& straight, double narrowest);

}  // namespace roadfix
