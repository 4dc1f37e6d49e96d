// Where the cells of a grid lie on the metric plane of a UTM zone.
//
// Row 0 is the northern row; column 0 the western column. Cells are squares of a power of two metres and their
// corners lie on the lattice of multiples of the cell size: grids of the same zone always line up.
#pragma once

#include <cmath>
#include <optional>

#include "core/units/planar.hpp"

namespace roadfix {

/// Index of a cell on the infinite lattice of a cell size. `col` grows to the east, `row` to the *south*
/// (row = -north / cell), so that a larger row is further down a picture.
struct LatticeIndex {
  int col = 0;
  int row = 0;
  friend bool operator==(const LatticeIndex&, const LatticeIndex&) = default;
};

/// The cell that a point lies in; one on an edge belongs to the cell east or south of it.
inline LatticeIndex lattice_index(GridPoint point, double cell_m) {
  return {static_cast<int>(std::floor(point.east_m / cell_m)), static_cast<int>(std::floor(-point.north_m / cell_m))};
}

inline constexpr double kMinCellM = 0.25;
inline constexpr double kMaxCellM = 16.0;

/// A power of two from 0.25 to 16 m, the sizes that a map may have (overviews are coarser).
bool is_map_cell_size(double cell_m);

struct GridGeometry {
  double cell_m = 1.0;
  LatticeIndex origin;  ///< the north-western cell
  int cols = 0;
  int rows = 0;

  /// Smallest grid of that cell size that covers the box.
  static GridGeometry covering(const GridBox& box, double cell_m);

  GridBox box() const;
  GridPoint cell_center(int col, int row) const;
  /// Continuous cell coordinates: (0, 0) is the outer corner of the north-western cell, (0.5, 0.5) its centre.
  struct CellPosition {
    double col = 0.0;
    double row = 0.0;

    friend bool operator==(const CellPosition&, const CellPosition&) = default;
  };
  CellPosition position_of(GridPoint point) const;
  GridPoint point_at(CellPosition position) const;

  /// So many cells more on every side.
  GridGeometry padded(int margin_cells) const;
  /// The part of both that overlaps; nullopt when none does. Cell sizes must be equal.
  std::optional<GridGeometry> intersection(const GridGeometry& other) const;

  friend bool operator==(const GridGeometry&, const GridGeometry&) = default;
};

}  // namespace roadfix
