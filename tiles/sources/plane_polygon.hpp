// A simple polygon on the plane of a zone: the ground that a road extract covers.
#pragma once

#include <vector>

#include "core/grid/geometry.hpp"

namespace roadfix {

class PlanePolygon {
 public:
  /// The ring closes by itself. At least three points.
  explicit PlanePolygon(std::vector<GridPoint> ring);

  const GridBox& box() const { return box_; }
  /// Sets the cells whose centre lies inside to true.
  void mark(const GridGeometry& block, std::vector<bool>& inside) const;

 private:
  std::vector<GridPoint> ring_;
  GridBox box_;
};

}  // namespace roadfix
