// Exact sums of the map under a footprint whose nadir is anywhere in a block.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/proof/bound_map.hpp"
#include "core/proof/bound_sums.hpp"
#include "core/proof/row_run.hpp"
#include "core/proof/score_bound.hpp"

namespace roadfix {

/// The least and the largest of sums under a footprint over the positions of a block.
struct GroundRange {
  Interval cells;           ///< that the map has observed
  Interval value;           ///< above the map's base
  double square_min = 0.0;  ///< of those
  double mixed_max = 0.0;   ///< of value (map span - value)
};

/// Part of a map as sums along its rows, so that a run of cells is a difference of two. Thread-safe once built.
class GroundSums {
 public:
  /// Of cols x rows cells from (col, row) of the map on; what lies beyond it is unobserved.
  GroundSums(const BoundMap& map, int col, int row, int cols, int rows);

  /// `footprint`: its observed cells, relative to the nadir. From every position of the block (col, row) of the map it
  /// lies within the part.
  GroundRange below(std::span<const RowRun> footprint, int block_col, int block_row) const;

 private:
  int col_;
  int row_;
  std::ptrdiff_t stride_;
  double span_;
  std::vector<CellSums> before_;  ///< each cell, and the end of its row
};

}  // namespace roadfix
