// The sums of a bound for a run of neighbouring blocks, vectorised for the processor that runs it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/proof/bound_map.hpp"
#include "core/proof/bound_terms.hpp"
#include "core/proof/row_run.hpp"

namespace roadfix {

using RunSums = std::array<std::uint32_t, BoundMap::kRun>;

/// For the blocks (col, row), (col + 1, row), ...: the sum of the terms, in units of terms.unit.
void term_sums(const BoundMap& map, const BoundTerms& terms, int col, int row, RunSums& sums);

/// For the same blocks: observed cells, values and squares of the covered blocks.
struct CoveredSums {
  RunSums cells{}, value{}, square{};
};
void covered_sums(const BoundMap& map, std::span<const RowRun> runs, int col, int row, CoveredSums& sums);

/// Sums over the cells of a map row before a cell; a run of cells is the difference of two.
struct CellSums {
  std::uint64_t cells_and_values = 0;  ///< observed cells + 2^32 times values above the map's base
  std::uint64_t squares = 0;           ///< of those values
};
/// The sums over the cells below a footprint with its nadir at `nadir`, and at each cell to the right of that.
/// `footprint`: its observed cells, relative to the nadir; `nadir` points into rows of sums that are `stride` apart.
void cell_sums(std::span<const RowRun> footprint, const CellSums* nadir, std::ptrdiff_t stride,
               std::array<CellSums, kBlockCells>& sums);

}  // namespace roadfix
