#include "core/grid/relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/grid/sampling.hpp"

namespace roadfix {
namespace {

using CellPosition = GridGeometry::CellPosition;

constexpr double kLeastStretch = 0.5;
constexpr double kMostStretch = 2.0;

/// What holds all that was reached, in cells from the nadir.
struct Extent {
  CellPosition first{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  CellPosition last{-first.col, -first.row};

  void reach(double col, double row) {
    first = {std::min(first.col, std::floor(col)), std::min(first.row, std::floor(row))};
    last = {std::max(last.col, std::ceil(col)), std::max(last.row, std::ceil(row))};
  }
};

/// Visits places along the edges, in cells from the nadir.
template <typename Visit>
void along_edges(const FeatureMap& features, const Visit& visit) {
  const double right = features.cells.cols() - features.nadir.col;
  const double behind = features.cells.rows() - features.nadir.row;
  for (int col = 0; col <= features.cells.cols(); ++col) {
    visit(col - features.nadir.col, -features.nadir.row);
    visit(col - features.nadir.col, behind);
  }
  for (int row = 0; row <= features.cells.rows(); ++row) {
    visit(-features.nadir.col, row - features.nadir.row);
    visit(right, row - features.nadir.row);
  }
}

/// Each cell of `source` anew, from where `source_of` says, both in cells from the nadir.
template <typename SourceOf>
FeatureMap resampled_about(CellPosition nadir, const FeatureMap& source, int cols, int rows,
                           const SourceOf& source_of) {
  CellArray cells(cols, rows);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const CellPosition from = source_of(col + 0.5 - nadir.col, row + 0.5 - nadir.row);
      cells.at(col, row) = bilinear(source.cells, {source.nadir.col + from.col, source.nadir.row + from.row});
    }
  }
  return {std::move(cells), source.cell_m, nadir, source.nadir_sigma_m, source.nadir_heading_sigma};
}

}  // namespace

Relief::Relief(const Terrain& terrain, const GridPose& pose, double agl_m)
    : terrain_(&terrain),
      nadir_(pose.position),
      sin_(sin(pose.heading)),
      cos_(cos(pose.heading)),
      agl_m_(agl_m),
      level_m_(terrain.height_m(pose.position).value_or(std::numeric_limits<double>::quiet_NaN())) {}

double Relief::stretch_of(double right_m, double back_m) const {
  const auto height_m = terrain_->height_m(
      {nadir_.east_m + cos_ * right_m - sin_ * back_m, nadir_.north_m - sin_ * right_m - cos_ * back_m});
  if (!height_m || std::isnan(level_m_)) return 1.0;
  const double share = (*height_m - level_m_) / agl_m_;
  return 1.0 / std::clamp(1.0 - share, 1.0 / kMostStretch, 1.0 / kLeastStretch);
}

double Relief::stretch_at(double right_m, double back_m) const {
  constexpr int kSteps = 4;  // each leaves of the error the share that the slope is of the line of sight
  double stretch = 1.0;
  for (int k = 0; k < kSteps; ++k) stretch = stretch_of(right_m / stretch, back_m / stretch);
  return stretch;
}

double Relief::largest_shift_m(const FeatureMap& features) const {
  double largest_m = 0.0;
  along_edges(features, [&](double col, double row) {
    const double stretch = stretch_at(features.cell_m * col, features.cell_m * row);
    largest_m = std::max(largest_m, features.cell_m * std::hypot(col, row) * std::abs(1.0 - 1.0 / stretch));
  });
  return largest_m;
}

FeatureMap levelled(const FeatureMap& features, const Relief& relief) {
  const double cell_m = features.cell_m;
  Extent extent;
  along_edges(features, [&](double col, double row) {
    const double stretch = relief.stretch_at(cell_m * col, cell_m * row);
    extent.reach(col / stretch, row / stretch);
  });
  const int cols = std::max(1, static_cast<int>(extent.last.col - extent.first.col));
  const int rows = std::max(1, static_cast<int>(extent.last.row - extent.first.row));
  const CellPosition nadir{-extent.first.col, -extent.first.row};
  return resampled_about(nadir, features, cols, rows, [&](double col, double row) {
    const double stretch = relief.stretch_of(cell_m * col, cell_m * row);
    return CellPosition{stretch * col, stretch * row};
  });
}

FeatureMap shown_in_relief(const FeatureMap& ground, const Relief& relief, int cols, int rows) {
  return resampled_about({0.5 * cols, 0.5 * rows}, ground, cols, rows, [&](double col, double row) {
    const double stretch = relief.stretch_at(ground.cell_m * col, ground.cell_m * row);
    return CellPosition{col / stretch, row / stretch};
  });
}

}  // namespace roadfix
