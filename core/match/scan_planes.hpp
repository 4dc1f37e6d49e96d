// Cells as planes of numbers, for the sums of a scan, and as the coarser blocks in which its means are known.
#pragma once

#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/match/float_plane.hpp"

namespace roadfix {

/// Observed cells as three planes: 1 where observed, the value less a mean, and its square.
struct ScanPlanes {
  FloatPlane observed, value, square;
};

/// Of the observed cells; 0 where there is none.
double mean_of(const CellArray& cells);
ScanPlanes planes_of(const CellArray& cells, double mean);

/// Sum over blocks of q x q cells, the first block starting `lead` cells before the first cell.
FloatPlane block_sums(const FloatPlane& plane, int q, int lead);

/// Linear interpolation between two blocks.
struct BlockMix {
  int first = 0;
  int second = 0;
  float share = 0.0F;  ///< of the second
  float of(float a, float b) const { return a + share * (b - a); }
};

/// For `count` cells from `start` on: between which of the `blocks` they lie. Block b of q cells starts at cell b * q
/// and has place b + offset.
std::vector<BlockMix> mixes(int count, int start, int q, int offset, int blocks);

}  // namespace roadfix
