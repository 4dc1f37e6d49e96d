#include "core/grid/terrain.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

Terrain Terrain::unknown(const GridGeometry& geometry) {
  const auto cells = static_cast<std::size_t>(geometry.cols) * static_cast<std::size_t>(geometry.rows);
  return {geometry, std::vector<std::uint16_t>(cells, kUnknown)};
}

std::uint16_t Terrain::code_of(double height_m) {
  if (std::isnan(height_m)) return kUnknown;
  const double within_m = std::clamp(height_m, kHeights.lowest_m, kHeights.highest_m);
  return static_cast<std::uint16_t>(std::lround((within_m - kLowestM) / kStepM));
}

std::optional<double> Terrain::cell_height_m(int col, int row) const {
  if (col < 0 || row < 0 || col >= geometry.cols || row >= geometry.rows) return std::nullopt;
  const std::uint16_t code =
      codes[static_cast<std::size_t>(row) * static_cast<std::size_t>(geometry.cols) + static_cast<std::size_t>(col)];
  if (code == kUnknown) return std::nullopt;
  return kLowestM + kStepM * code;
}

std::optional<double> Terrain::height_m(GridPoint point) const {
  if (!grown(geometry.box(), geometry.cell_m).contains(point)) return std::nullopt;
  const auto at = geometry.position_of(point);
  const double left = std::floor(at.col - 0.5);
  const double top = std::floor(at.row - 0.5);
  double sum = 0.0;
  double weights = 0.0;
  for (const double col : {left, left + 1.0}) {
    for (const double row : {top, top + 1.0}) {
      const double weight = (1.0 - std::abs(at.col - 0.5 - col)) * (1.0 - std::abs(at.row - 0.5 - row));
      if (weight <= 0.0) continue;
      const auto height = cell_height_m(static_cast<int>(col), static_cast<int>(row));
      if (!height) continue;
      sum += weight * *height;
      weights += weight;
    }
  }
  if (weights <= 0.0) return std::nullopt;
  return sum / weights;
}

std::optional<double> Terrain::height_above_ground_m(GridPoint point, double above_sea_m) const {
  const auto ground_m = height_m(point);
  if (!ground_m || *ground_m >= above_sea_m) return std::nullopt;
  return above_sea_m - *ground_m;
}

std::optional<HeightRange> Terrain::heights_within(const GridBox& box) const {
  const auto part = GridGeometry::covering(box, geometry.cell_m).padded(1).intersection(geometry);
  if (!part) return std::nullopt;
  std::optional<HeightRange> range;
  const int first_col = part->origin.col - geometry.origin.col;
  const int first_row = part->origin.row - geometry.origin.row;
  for (int row = first_row; row < first_row + part->rows; ++row) {
    for (int col = first_col; col < first_col + part->cols; ++col) {
      const auto height = cell_height_m(col, row);
      if (!height) continue;
      if (!range) range = HeightRange{*height, *height};
      range->lowest_m = std::min(range->lowest_m, *height);
      range->highest_m = std::max(range->highest_m, *height);
    }
  }
  return range;
}

}  // namespace roadfix
