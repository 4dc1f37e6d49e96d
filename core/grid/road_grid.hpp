// A piece of road map: cells with their place on the plane of a UTM zone.
#pragma once

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
};

}  // namespace roadfix
