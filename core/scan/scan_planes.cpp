#include "core/scan/scan_planes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/scan/scan_kernel.hpp"
#include "core/units/floor_div.hpp"

namespace roadfix {
namespace {

/// The value of each kind of cell less a mean; 0 for those not observed.
std::array<float, 256> value_table(double mean) {
  std::array<float, 256> table{};
  for (int cell = kNoRoad; cell <= kRoad; ++cell) {
    table[static_cast<std::size_t>(cell)] = static_cast<float>(probability(static_cast<Cell>(cell)) - mean);
  }
  return table;
}

}  // namespace

FloatPlane values_of(const CellArray& cells, double mean) {
  const std::array<float, 256> value = value_table(mean);
  FloatPlane plane(cells.cols(), cells.rows());
  std::ranges::transform(cells.cells(), plane.values.begin(), [&](Cell cell) { return value[cell]; });
  return plane;
}

BlockSumPlanes block_sums(const CellArray& cells, double mean, const BlockTiling& tiling) {
  const int block_cells = tiling.block_cells;
  const int lead = tiling.lead_cells;
  const std::array<float, 256> value_of = value_table(mean);
  const auto blocks = [&](int count) { return (count + lead + block_cells - 1) / block_cells; };
  const FloatPlane empty(blocks(cells.cols()), blocks(cells.rows()));
  BlockSumPlanes sums{empty, empty, empty};
  for (int row = 0; row < cells.rows(); ++row) {
    const auto in = cells.row(row);
    const int block_row = (row + lead) / block_cells;
    float* observed = sums.observed.row(block_row);
    float* value = sums.value.row(block_row);
    float* square = sums.square.row(block_row);
    int block = lead / block_cells;
    int left = block_cells - lead % block_cells;  // cells of the block
    for (const Cell cell : in) {
      const float v = value_of[cell];
      observed[block] += is_observed(cell) ? 1.0F : 0.0F;
      value[block] += v;
      square[block] += v * v;
      if (--left > 0) continue;
      left = block_cells;
      ++block;
    }
  }
  return sums;
}

InterpolationTaps interpolation_taps(const BlockAxis& axis, int first_cell, int cells) {
  const auto size = static_cast<std::size_t>(cells + kRowOverrun);
  InterpolationTaps taps{std::vector<std::int32_t>(size), std::vector<std::int32_t>(size), std::vector<float>(size)};
  const auto index_of = [&](int block) { return std::clamp(block + axis.block_of_cell_0, 0, axis.blocks - 1); };
  for (int i = 0; i < cells; ++i) {
    const int cell = first_cell + i;
    const int block = floor_div(cell, axis.block_cells);
    const auto at = static_cast<std::size_t>(i);
    taps.first[at] = index_of(block);
    taps.second[at] = index_of(block + 1);
    taps.share[at] = static_cast<float>(cell - block * axis.block_cells) / static_cast<float>(axis.block_cells);
  }
  return taps;
}

}  // namespace roadfix
