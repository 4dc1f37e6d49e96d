// How much of each cell of a block is covered by roads: lines with a width and round ends, counted in 8 x 8 samples a
// cell. Where roads overlap, the ground is counted once.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/geometry.hpp"

namespace roadfix {

class LineCoverage {
 public:
  explicit LineCoverage(const GridGeometry& block);

  /// Adds all ground within `half_width_m` of the segment.
  void add(GridPoint from, GridPoint to, double half_width_m);
  /// Share of the cell that is covered, in [0, 1].
  double share(int col, int row) const;

 private:
  void add_row(int sample_row, double first, double last);

  GridGeometry block_;
  std::vector<std::uint64_t> samples_;  ///< of each cell: one byte a row of samples, one bit a sample
};

}  // namespace roadfix
