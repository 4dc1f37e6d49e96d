// A piece of road map: cells with their place on the plane of a UTM zone.
#pragma once

#include <cmath>

#include "core/grid/cell_array.hpp"
#include "core/grid/geometry.hpp"

namespace roadfix {

/// Invariant: cells.cols() == geometry.cols and cells.rows() == geometry.rows.
struct RoadGrid {
  GridGeometry geometry;
  CellArray cells;

  static RoadGrid unobserved(const GridGeometry& geometry) {
    return {geometry, CellArray(geometry.cols, geometry.rows)};
  }

  /// The one that holds the point; kUnobserved outside the grid.
  Cell cell_at(GridPoint point) const {
    const auto at = geometry.position_of(point);
    return cells.get(static_cast<int>(std::floor(at.col)), static_cast<int>(std::floor(at.row)));
  }
};

}  // namespace roadfix
