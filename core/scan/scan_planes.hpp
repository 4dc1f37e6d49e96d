// Cells as planes of numbers, for the sums of a scan, and as the coarser blocks in which its means are known.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/scan/float_plane.hpp"

namespace roadfix {

/// What is observed as its value less a mean, 0 elsewhere.
FloatPlane values_of(const CellArray& cells, double mean);

/// How cells fall into square blocks.
struct BlockTiling {
  int block_cells = 1;  ///< along an edge
  int lead_cells = 0;   ///< so many cells before the first one the first block begins
};

/// Sums over blocks of cells: of observed cells, of their values less a mean, and of the squares of these.
struct BlockSumPlanes {
  FloatPlane observed, value, square;
};
BlockSumPlanes block_sums(const CellArray& cells, double mean, const BlockTiling& tiling);

/// The two blocks that each cell of a row or column is interpolated between, linearly, and the share of the second. As
/// many more as vectors may read beyond the last one (kRowOverrun).
struct InterpolationTaps {
  std::vector<std::int32_t> first, second;
  std::vector<float> share;
};

/// A row or column of a plane of blocks. Cells beyond its ends take the block at the end.
struct BlockAxis {
  int block_cells = 1;
  int block_of_cell_0 = 0;  ///< index of the block that begins at cell 0, which may lie beyond the ends
  int blocks = 1;           ///< in all, at least 1
};

/// Of `cells` cells from `first_cell` on, which may be negative.
InterpolationTaps interpolation_taps(const BlockAxis& axis, int first_cell, int cells);

}  // namespace roadfix
