// A polygon on the plane of a zone: the ground that a road extract covers.
#pragma once

#include <vector>

#include "core/grid/geometry.hpp"

namespace roadfix {

class PlanePolygon {
 public:
  /// The outer ring and its holes. Rings close by themselves; the outer one has at least three points.
  explicit PlanePolygon(std::vector<GridPoint> outer, std::vector<std::vector<GridPoint>> holes = {});

  const GridBox& box() const { return box_; }
  /// Sets the cells whose centre lies inside to true.
  void mark(const GridGeometry& block, std::vector<bool>& inside) const;

 private:
  std::vector<std::vector<GridPoint>> rings_;  ///< the outer one first
  GridBox box_;
};

}  // namespace roadfix
