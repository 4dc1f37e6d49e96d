// A polygon on the plane of a zone: the ground that a road extract covers.
//
// Borders have a hundred thousand corners, and a country ten thousand blocks: the edges are kept by strips of
// northings, so that a block looks at those beside it only. Memory: about 50 bytes a corner.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/grid/geometry.hpp"

namespace roadfix {

class PlanePolygon {
 public:
  /// The outer ring and its holes. Rings close by themselves; the outer one has at least three points.
  explicit PlanePolygon(const std::vector<GridPoint>& outer, const std::vector<std::vector<GridPoint>>& holes = {});

  const GridBox& box() const { return box_; }
  /// Gives the cells of the block whose centre lies inside this value.
  void fill(const GridGeometry& block, Cell value, CellArray& cells) const;

 private:
  struct Edge {
    GridPoint from;
    GridPoint to;
  };
  /// A crossing of an edge with the middle of a row of cells.
  struct Crossing {
    int row = 0;
    double east_m = 0.0;
  };
  struct Strips {
    std::size_t first = 0;
    std::size_t last = 0;
  };

  void add_ring(const std::vector<GridPoint>& ring);
  void sort_into_strips();
  Strips strips_between(double south_m, double north_m) const;
  Strips strips_of(const Edge& edge) const;
  std::vector<Crossing> crossings(const GridGeometry& block) const;
  void add_crossings(const Edge& edge, const GridGeometry& block, std::vector<Crossing>& found) const;

  GridBox box_;              ///< of the outer ring
  std::vector<Edge> edges_;  ///< those that are not level: level ones cross no row
  double south_m_ = 0.0;     ///< of the lowest edge
  double strip_m_ = 0.0;
  std::vector<std::size_t> starts_;      ///< of each strip in `in_strip_`, and the end of the last
  std::vector<std::uint32_t> in_strip_;  ///< edges that reach into a strip, strip by strip
};

}  // namespace roadfix
