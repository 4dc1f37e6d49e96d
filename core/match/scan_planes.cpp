#include "core/match/scan_planes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/match/scan_kernel.hpp"
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

BlockSumPlanes block_sums(const CellArray& cells, double mean, int q, int lead) {
  const std::array<float, 256> value_of = value_table(mean);
  const auto blocks = [&](int count) { return (count + lead + q - 1) / q; };
  const FloatPlane empty(blocks(cells.cols()), blocks(cells.rows()));
  BlockSumPlanes sums{empty, empty, empty};
  for (int row = 0; row < cells.rows(); ++row) {
    const auto in = cells.row(row);
    const int block_row = (row + lead) / q;
    float* observed = sums.observed.row(block_row);
    float* value = sums.value.row(block_row);
    float* square = sums.square.row(block_row);
    int block = lead / q;
    int left = q - lead % q;  // cells of the block
    for (const Cell cell : in) {
      const float v = value_of[cell];
      observed[block] += is_observed(cell) ? 1.0F : 0.0F;
      value[block] += v;
      square[block] += v * v;
      if (--left > 0) continue;
      left = q;
      ++block;
    }
  }
  return sums;
}

BlockMixes mixes(int count, int start, int q, int offset, int blocks) {
  const auto size = static_cast<std::size_t>(count + kRowOverrun);
  BlockMixes result{std::vector<std::int32_t>(size), std::vector<std::int32_t>(size), std::vector<float>(size)};
  for (int i = 0; i < count; ++i) {
    const int block = floor_div(start + i, q);
    const auto place = [&](int b) { return std::clamp(b + offset, 0, blocks - 1); };
    const auto at = static_cast<std::size_t>(i);
    result.first[at] = place(block);
    result.second[at] = place(block + 1);
    result.share[at] = static_cast<float>(start + i - block * q) / static_cast<float>(q);
  }
  return result;
}

}  // namespace roadfix
