// Roads around a place, drawn into the cells around it.
#pragma once

#include "tests/tiles/roads/road_features.hpp"
#include "tiles/roads/vector_roads.hpp"

namespace roadfix::testing {

class VectorRoads : public RoadFeatures {
 protected:
  static CellArray cells(const CellSource& source) { return source.read(kWindow, 1); }
  static constexpr GridGeometry kWindow{2.0, {199900, -2100100}, 200, 200};  // 200 m around the centre
};

}  // namespace roadfix::testing
