#include "core/grid/combine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "core/grid/cell_size.hpp"
#include "core/grid/log_odds.hpp"
#include "core/units/error.hpp"
#include "core/units/index_range.hpp"

namespace roadfix {
namespace {

using CellPosition = GridGeometry::CellPosition;

/// In cells to the right of and behind the reference's nadir.
struct Box {
  double left = std::numeric_limits<double>::infinity();
  double right = -left;
  double front = left;
  double back = -left;

  void take(CellPosition p) {
    left = std::min(left, p.col);
    right = std::max(right, p.col);
    front = std::min(front, p.row);
    back = std::max(back, p.row);
  }
};

CellPosition centre_of(const PlacedFeatures& part) {
  return {part.offset.right_m / part.features.cell_m, -part.offset.forward_m / part.features.cell_m};
}

Box box_of(std::span<const PlacedFeatures> parts) {
  Box box;
  for (const PlacedFeatures& part : parts) {
    const double c = cos(part.offset.turn);
    const double s = sin(part.offset.turn);
    const CellPosition centre = centre_of(part);
    const auto cols = static_cast<double>(part.features.cells.cols());
    const auto rows = static_cast<double>(part.features.cells.rows());
    for (const CellPosition corner : std::array<CellPosition, 4>{{{0, 0}, {cols, 0}, {0, rows}, {cols, rows}}}) {
      const double right = corner.col - part.features.nadir.col;
      const double back = corner.row - part.features.nadir.row;
      box.take({centre.col + c * right - s * back, centre.row + s * right + c * back});
    }
  }
  return box;
}

/// Sum and number of log-odds of each cell.
struct LogOddsSums {
  std::vector<float> sum;
  std::vector<std::uint8_t> count;
};

std::array<float, kRoad + 1> log_odds_of_cells() {
  std::array<float, kRoad + 1> all{};
  for (Cell cell = kNoRoad; cell <= kRoad; ++cell) all[cell] = static_cast<float>(log_odds(cell));
  return all;
}

/// Of so many columns or rows those that reach between the two: bilinear() gives nothing of what lies beyond.
IndexRange reached(double low, double high, int count) {
  return {std::max(0, static_cast<int>(std::floor(low))), std::min(count, static_cast<int>(std::ceil(high)))};
}

void add(const PlacedFeatures& part, CellPosition nadir, int cols, int rows, LogOddsSums& sums) {
  static const std::array<float, kRoad + 1> kLogOdds = log_odds_of_cells();
  const Placement placement = placement_in(part, nadir);
  const Box box = box_of({&part, 1});
  const IndexRange across = reached(nadir.col + box.left, nadir.col + box.right, cols);
  const IndexRange along = reached(nadir.row + box.front, nadir.row + box.back, rows);
  for (int row = along.first; row < along.end; ++row) {
    for (int col = across.first; col < across.end; ++col) {
      const Cell cell = bilinear(part.features.cells, placement.source_of(col + 0.5, row + 0.5));
      if (!is_observed(cell)) continue;
      const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
      sums.sum[i] += kLogOdds[cell];
      ++sums.count[i];
    }
  }
}

/// Feature maps that say their cell size themselves need not agree.
void require_cells_of(double cell_m, std::span<const PlacedFeatures> parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double other_m = parts[i].features.cell_m;
    if (is_same_cell_size(other_m, cell_m)) continue;
    throw InvalidInput("cell-size-contradictory",
                       fmt::format("of {} frames the first has cells of {} m, number {} has cells of {} m: make all "
                                   "feature maps in cells of one size",
                                   parts.size(), cell_m, i + 1, other_m));
  }
}

}  // namespace

Placement placement_in(const PlacedFeatures& part, CellPosition nadir) {
  const double c = cos(part.offset.turn);
  const double s = sin(part.offset.turn);
  const CellPosition centre = centre_of(part);
  const double right = -nadir.col - centre.col;
  const double back = -nadir.row - centre.row;
  return {{part.features.nadir.col + c * right + s * back, part.features.nadir.row - s * right + c * back},
          {c, -s},
          {s, c}};
}

FeatureMap combined(std::span<const PlacedFeatures> parts, double max_cells) {
  assert(!parts.empty() && parts.size() < 256);
  const double cell_m = parts.front().features.cell_m;
  require_cells_of(cell_m, parts);
  const Box box = box_of(parts);
  const double width = std::ceil(box.right - box.left - 1e-9);
  const double height = std::ceil(box.back - box.front - 1e-9);
  if (!(width * height <= max_cells)) {
    throw LimitExceeded("frames-too-far-apart",
                        fmt::format("together the frames cover {:.0f} x {:.0f} m, {:.0f} cells of {} m; at most {:.0f} "
                                    "are allowed: check their offsets, or leave the farthest out",
                                    width * cell_m, height * cell_m, width * height, cell_m, max_cells));
  }
  const int cols = std::max(1, static_cast<int>(width));
  const int rows = std::max(1, static_cast<int>(height));
  const CellPosition nadir{-box.left, -box.front};
  FeatureMap result{CellArray(cols, rows), cell_m, nadir};
  for (const PlacedFeatures& part : parts) {
    result.nadir_sigma_m = std::max(result.nadir_sigma_m, part.features.nadir_sigma_m);
    result.nadir_heading_sigma = std::max(result.nadir_heading_sigma, part.features.nadir_heading_sigma);
  }
  LogOddsSums sums{std::vector<float>(result.cells.cells().size()),
                   std::vector<std::uint8_t>(result.cells.cells().size())};
  for (const PlacedFeatures& part : parts) add(part, nadir, cols, rows, sums);
  const auto cells = result.cells.cells();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (sums.count[i] == 0) continue;
    const double mean = static_cast<double>(sums.sum[i]) / sums.count[i];
    cells[i] = cell_from_log_odds(mean);
  }
  return result;
}

}  // namespace roadfix
