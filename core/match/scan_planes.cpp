#include "core/match/scan_planes.hpp"

#include <algorithm>
#include <cstdint>

namespace roadfix {
namespace {

int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

double mean_of(const CellArray& cells) {
  double sum = 0.0;
  std::int64_t count = 0;
  for (const Cell cell : cells.cells()) {
    if (!is_observed(cell)) continue;
    sum += probability(cell);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

ScanPlanes planes_of(const CellArray& cells, double mean) {
  const FloatPlane empty(cells.cols(), cells.rows());
  ScanPlanes planes{empty, empty, empty};
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      const Cell cell = cells.at(col, row);
      if (!is_observed(cell)) continue;
      const auto value = static_cast<float>(probability(cell) - mean);
      planes.observed.at(col, row) = 1.0F;
      planes.value.at(col, row) = value;
      planes.square.at(col, row) = value * value;
    }
  }
  return planes;
}

FloatPlane block_sums(const FloatPlane& plane, int q, int lead) {
  const auto blocks = [&](int cells) { return (cells + lead + q - 1) / q; };
  FloatPlane sums(blocks(plane.cols), blocks(plane.rows));
  for (int row = 0; row < plane.rows; ++row) {
    for (int col = 0; col < plane.cols; ++col) sums.at((col + lead) / q, (row + lead) / q) += plane.at(col, row);
  }
  return sums;
}

std::vector<BlockMix> mixes(int count, int start, int q, int offset, int blocks) {
  std::vector<BlockMix> result;
  for (int cell = start; cell < start + count; ++cell) {
    const int block = floor_div(cell, q);
    const auto place = [&](int i) { return std::clamp(i + offset, 0, blocks - 1); };
    result.push_back({place(block), place(block + 1), static_cast<float>(cell - block * q) / static_cast<float>(q)});
  }
  return result;
}

}  // namespace roadfix
