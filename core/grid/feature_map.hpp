// What a UAV sees: a metric grid of road probability in the body frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grid/cell_array.hpp"
#include "core/grid/geometry.hpp"
#include "core/units/angle.hpp"

namespace roadfix {

/// Row 0 is the forward edge, columns run to the right of travel.
struct FeatureMap {
  CellArray cells;
  double cell_m = 1.0;
  /// The point below the UAV in continuous cell coordinates ((0, 0) = outer corner of the first cell).
  GridGeometry::CellPosition nadir;
  /// How well that point is known, as far as roll and pitch are: 1 sigma per axis.
  double nadir_sigma_m = 0.0;
  /// How far what is seen may be turned about it, as far as roll, pitch and height are known: 1 sigma.
  Angle nadir_heading_sigma{};

  static FeatureMap centred(CellArray cells, double cell_m) {
    const GridGeometry::CellPosition centre{cells.cols() / 2.0, cells.rows() / 2.0};
    return {std::move(cells), cell_m, centre};
  }

  /// The longer side.
  double side_m() const { return cell_m * std::max(cells.cols(), cells.rows()); }
  /// From the middle to the nadir, in cells.
  double off_nadir_cells() const { return std::hypot(nadir.col - cells.cols() / 2.0, nadir.row - cells.rows() / 2.0); }

  friend bool operator==(const FeatureMap&, const FeatureMap&) = default;
};

}  // namespace roadfix
