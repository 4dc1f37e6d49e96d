// Cells as planes of numbers, for the sums of a scan, and as the coarser blocks in which its means are known.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/match/float_plane.hpp"

namespace roadfix {

/// What is observed as its value less a mean, 0 elsewhere.
FloatPlane values_of(const CellArray& cells, double mean);

/// Sums over blocks of q x q cells, the first block starting `lead` cells before the first cell: of observed cells, of
/// their values less a mean, and of the squares of these.
struct BlockSumPlanes {
  FloatPlane observed, value, square;
};
BlockSumPlanes block_sums(const CellArray& cells, double mean, int q, int lead);

/// Linear interpolation between two blocks: which ones, and the share of the second. Cell by cell, and as many more as
/// vectors may read beyond the last one.
struct BlockMixes {
  std::vector<std::int32_t> first, second;
  std::vector<float> share;
};

/// For `count` cells from `start` on: between which of the `blocks` they lie. Block b of q cells starts at cell b * q
/// and has place b + offset.
BlockMixes mixes(int count, int start, int q, int offset, int blocks);

}  // namespace roadfix
