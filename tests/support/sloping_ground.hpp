// Ground that rises evenly to the east, and what is seen of it from a height above the sea.
#pragma once

#include <cmath>

#include "core/grid/terrain.hpp"
#include "core/locate/altitude.hpp"

namespace roadfix::testing {

struct SlopingGround {
  GridBox box;
  double west_m = 200.0;  ///< above the sea
  double east_m = 260.0;

  double height_m(GridPoint point) const {
    return west_m + (east_m - west_m) * (point.east_m - box.min.east_m) / box.width_m();
  }
  Terrain terrain() const {
    Terrain result = Terrain::unknown(GridGeometry::covering(box, Terrain::kFinestCellM).padded(10));
    const GridGeometry& geometry = result.geometry;
    for (std::size_t i = 0; i < result.codes.size(); ++i) {
      const auto cols = static_cast<std::size_t>(geometry.cols);
      result.codes[i] =
          Terrain::code_of(height_m(geometry.cell_center(static_cast<int>(i % cols), static_cast<int>(i / cols))));
    }
    return result;
  }
  /// What shows the ground below the point as it is, as somebody makes it who takes the vehicle to be at that altitude.
  FeatureMap taken_for(FeatureMap seen, GridPoint point, const Altitude& altitude) const {
    seen.cell_m *= altitude.agl_m / (*altitude.above_sea_m - height_m(point));
    return seen;
  }
};

}  // namespace roadfix::testing
