// Which cells of the map a footprint covers from any position of a small square, and which from every one.
#pragma once

#include "core/grid/feature_map.hpp"
#include "core/match/footprint.hpp"

namespace roadfix {

/// Of a footprint whose nadir lies on any of side x side cells, as seen from the first of them. Cells that are covered
/// have the value 0.
struct Coverage {
  Footprint always;     ///< from every one of the positions
  Footprint sometimes;  ///< from some of them, but not from all

  /// `north_up` as for Footprint; side >= 1.
  static Coverage of(const FeatureMap& north_up, int side);
};

}  // namespace roadfix
