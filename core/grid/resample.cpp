#include "core/grid/resample.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/grid/feature_rotator.hpp"
#include "core/grid/halving_kernel.hpp"
#include "core/grid/sampling.hpp"

namespace roadfix {
namespace {

using CellPosition = GridGeometry::CellPosition;

CellArray sampled(const CellArray& source, const Placement& placement, int cols, int rows) {
  // Each result cell averages n x n bilinear samples, n chosen so that no source cell is skipped.
  const double step = std::hypot(placement.right.col, placement.right.row);
  const int n = std::max(1, static_cast<int>(std::ceil(step - 1e-9)));
  CellArray result(cols, rows);
  for (int row = 0; row < rows; ++row) {
    const auto out = result.row(row);
    for (int col = 0; col < cols; ++col) {
      if (n == 1) {
        out[static_cast<std::size_t>(col)] = bilinear(source, placement.source_of(col + 0.5, row + 0.5));
        continue;
      }
      WeightedMean mean;
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i)
          mean.add(bilinear(source, placement.source_of(col + (i + 0.5) / n, row + (j + 0.5) / n)), 1.0);
      }
      out[static_cast<std::size_t>(col)] = mean.cell();
    }
  }
  return result;
}

/// Whether the corner of a cell lies there, and not so far away that its number does not fit.
bool lies_on_cells(CellPosition position) {
  constexpr double kFarthest = 1e9;
  const auto is_whole = [](double at) { return std::abs(at) < kFarthest && at == std::floor(at); };
  return is_whole(position.col) && is_whole(position.row);
}

/// What sampled() gives of cells that lie on those of the source.
CellArray copied(const CellArray& source, CellPosition origin, int cols, int rows) {
  CellArray result(cols, rows);
  paste(source, result, -static_cast<int>(origin.col), -static_cast<int>(origin.row));
  return result;
}

/// Whether less than a quarter of each cell of `step` source cells a side lies on the source, so that the result is
/// unobserved; taking the step^2 samples of such a cell would be without end.
bool covers_no_cell(const CellArray& source, double step) {
  return std::min<double>(source.cols(), step) * std::min<double>(source.rows(), step) < 0.25 * step * step;
}

constexpr int kSquare = 8;

/// The square of cells from (col, row) on, put where a quarter turn of the whole takes it. Eight cells of a row are one
/// number: blocks of 4, 2 and 1 cells change sides.
void turn_square(const CellArray& cells, CellArray& turned, int col, int row) {
  std::array<std::uint64_t, kSquare> rows{};
  for (std::size_t k = 0; k < kSquare; ++k) {
    std::memcpy(&rows[k], &cells.row(row + kSquare - 1 - static_cast<int>(k))[static_cast<std::size_t>(col)], kSquare);
  }
  const auto swap_blocks = [&](std::size_t side, std::uint64_t left) {
    for (std::size_t k = 0; k < kSquare; ++k) {
      if ((k & side) != 0) continue;
      const std::uint64_t both = ((rows[k] >> (8 * side)) ^ rows[k + side]) & left;
      rows[k + side] ^= both;
      rows[k] ^= both << (8 * side);
    }
  };
  static_assert(std::endian::native == std::endian::little);
  swap_blocks(4, 0x00000000FFFFFFFFU);
  swap_blocks(2, 0x0000FFFF0000FFFFU);
  swap_blocks(1, 0x00FF00FF00FF00FFU);
  const auto first = static_cast<std::size_t>(cells.rows() - kSquare - row);
  for (std::size_t k = 0; k < kSquare; ++k) {
    std::memcpy(&turned.row(col + static_cast<int>(k))[first], &rows[k], kSquare);
  }
}

}  // namespace

CellArray halved(const CellArray& cells) {
  CellArray result((cells.cols() + 1) / 2, (cells.rows() + 1) / 2);
  const std::vector<Cell> beyond(static_cast<std::size_t>(cells.cols()), kUnobserved);
  for (int row = 0; row < result.rows(); ++row) {
    const bool has_lower = 2 * row + 1 < cells.rows();
    halve_rows(cells.row(2 * row), has_lower ? cells.row(2 * row + 1) : std::span<const Cell>(beyond), result.row(row));
  }
  return result;
}

FeatureMap resampled(const FeatureMap& map, double cell_m, double scale) {
  assert(cell_m > 0.0 && scale > 0.0);
  const double step = cell_m / (scale * map.cell_m);
  if (step == 1.0) return {map.cells, cell_m, map.nadir, map.nadir_sigma_m, map.nadir_heading_sigma};
  const int cols = std::max(1, static_cast<int>(std::lround(map.cells.cols() / step)));
  const int rows = std::max(1, static_cast<int>(std::lround(map.cells.rows() / step)));
  // The nadir keeps its place on the ground; it is the fixed point of the resampling.
  const CellPosition nadir{map.nadir.col / step, map.nadir.row / step};
  FeatureMap result{CellArray(cols, rows), cell_m, nadir, map.nadir_sigma_m, map.nadir_heading_sigma};
  if (covers_no_cell(map.cells, step)) return result;
  const Placement placement{{0.0, 0.0}, {step, 0.0}, {0.0, step}};
  result.cells = sampled(map.cells, placement, cols, rows);
  return result;
}

FeatureMap rotated(const FeatureMap& map, Angle heading) { return FeatureRotator(map).rotated(heading); }

CellArray quarter_turned(const CellArray& cells) {
  CellArray turned(cells.rows(), cells.cols());
  for (int row = 0; row < cells.rows(); row += kSquare) {
    for (int col = 0; col < cells.cols(); col += kSquare) {
      const int rows = std::min(kSquare, cells.rows() - row);
      const int cols = std::min(kSquare, cells.cols() - col);
      if (rows == kSquare && cols == kSquare) {
        turn_square(cells, turned, col, row);
        continue;
      }
      for (int r = row; r < row + rows; ++r) {
        for (int c = col; c < col + cols; ++c) turned.at(cells.rows() - 1 - r, c) = cells.at(c, r);
      }
    }
  }
  return turned;
}

FeatureMap quarter_turned(const FeatureMap& map) {
  return {quarter_turned(map.cells), map.cell_m, {map.cells.rows() - map.nadir.row, map.nadir.col}};
}

FeatureMap cut_out(const RoadGrid& grid, const GridPose& pose, int cols, int rows, double cell_m) {
  assert(cols > 0 && rows > 0 && cell_m > 0.0);
  const double step = cell_m / grid.geometry.cell_m;
  const double c = step * cos(pose.heading);
  const double s = step * sin(pose.heading);
  const CellPosition at = grid.geometry.position_of(pose.position);
  const CellPosition centre{cols / 2.0, rows / 2.0};
  const Placement placement{
      {at.col - c * centre.col + s * centre.row, at.row - s * centre.col - c * centre.row}, {c, s}, {-s, c}};
  const bool is_copy = placement.right == CellPosition{1.0, 0.0} && lies_on_cells(placement.origin);
  return {is_copy ? copied(grid.cells, placement.origin, cols, rows) : sampled(grid.cells, placement, cols, rows),
          cell_m, centre};
}

}  // namespace roadfix
