// How much of each cell of a block is covered by roads: lines with a width and round ends, counted in 8 x 8 samples a
// cell. Where roads overlap, the ground is counted once.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/geometry.hpp"

namespace roadfix {

class LineCoverage {
 public:
  static constexpr int kSamples = 64;  ///< of a cell

  explicit LineCoverage(const GridGeometry& block);

  /// Adds all ground within `half_width_m` of the segment.
  void add(GridPoint from, GridPoint to, double half_width_m);
  /// How many of the kSamples of the cell are covered.
  int covered(int col, int row) const {
    const std::uint64_t samples = samples_[index(col, row)];
    return samples == 0 ? 0 : std::popcount(samples);  // of most cells none: counting is a call where no popcnt is sure
  }

 private:
  std::size_t index(int col, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(block_.cols) + static_cast<std::size_t>(col);
  }
  void add_row(int sample_row, double first, double last);

  GridGeometry block_;
  std::vector<std::uint64_t> samples_;  ///< of each cell: one byte a row of samples, one bit a sample
};

}  // namespace roadfix
