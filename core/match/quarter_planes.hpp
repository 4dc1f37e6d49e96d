// A window of the map and, if many poses share it, the same rotated by quarter turns. Matching a footprint on a window
// rotated to the left gives exactly what the footprint rotated to the right gives on the window as it is, so that
// headings a quarter turn apart share one turned and packed footprint.
#pragma once

#include <cstddef>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/grid/geometry.hpp"
#include "core/match/kernel.hpp"
#include "core/match/map_plane.hpp"

namespace roadfix {

class QuarterPlanes {
 public:
  QuarterPlanes(const CellArray& window, bool rotated);

  bool rotated() const { return planes_.size() > 1; }
  /// For headings that many quarter turns to the right of the footprint's: 0, and up to 3 if rotated().
  const MapPlane& plane(int quarters) const { return planes_[static_cast<std::size_t>(quarters)]; }
  /// Where a cell of the window lies in that plane.
  PlaneCell place(PlaneCell cell, int quarters) const;

 private:
  std::vector<MapPlane> planes_;
};

/// Whether rotating the window takes less time than turning and packing the footprints that it saves.
bool worth_rotating(const GridGeometry& window, int reach, double footprints_spared);

}  // namespace roadfix
