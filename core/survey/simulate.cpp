#include "core/survey/simulate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/grid/sampling.hpp"
#include "core/units/draws.hpp"

namespace roadfix {
namespace {

constexpr double kPatchRadiusM = 12.0;
constexpr double kStrokeLengthM = 60.0;
constexpr double kStrokeWidthM = 8.0;
constexpr double kTurn = 2.0 * std::numbers::pi;

using CellPosition = GridGeometry::CellPosition;

std::ptrdiff_t road_cells(const CellArray& cells) { return std::ranges::count_if(cells.cells(), is_road); }

/// Calls `visit(cell)` for each observed cell within `radius` cells of the segment a-b.
template <typename Visit>
void along(CellArray& cells, CellPosition a, CellPosition b, double radius, Visit visit) {
  const double east = b.col - a.col;
  const double south = b.row - a.row;
  const double length2 = std::max(east * east + south * south, 1e-12);
  const int first_row = std::max(0, static_cast<int>(std::min(a.row, b.row) - radius));
  const int last_row = std::min(cells.rows() - 1, static_cast<int>(std::max(a.row, b.row) + radius));
  const int first_col = std::max(0, static_cast<int>(std::min(a.col, b.col) - radius));
  const int last_col = std::min(cells.cols() - 1, static_cast<int>(std::max(a.col, b.col) + radius));
  for (int row = first_row; row <= last_row; ++row) {
    for (int col = first_col; col <= last_col; ++col) {
      const double right = col + 0.5 - a.col;
      const double down = row + 0.5 - a.row;
      const double t = std::clamp((right * east + down * south) / length2, 0.0, 1.0);
      const bool near = std::hypot(right - t * east, down - t * south) <= radius;
      if (near && is_observed(cells.at(col, row))) visit(cells.at(col, row));
    }
  }
}

CellPosition anywhere(const CellArray& cells, std::mt19937_64& random) {
  const double col = uniform(random, 0.0, cells.cols());
  return {col, uniform(random, 0.0, cells.rows())};
}

/// What this map usually says where there is no road, and where there is one. Errors have to look like that too: an
/// erased patch that is surer of no road than all ground around it can be told by that alone.
struct UsualCells {
  Cell no_road = kNoRoad;
  Cell road = kRoad;
};

UsualCells usual(const CellArray& cells) {
  std::array<std::int64_t, 256> count{};
  for (const Cell cell : cells.cells()) ++count[cell];
  const auto most_frequent = [&](int first, int last, Cell otherwise) {
    const auto top = std::max_element(count.begin() + first, count.begin() + last + 1);
    return *top > 0 ? static_cast<Cell>(top - count.begin()) : otherwise;
  };
  return {most_frequent(kNoRoad, kRoad / 2, kNoRoad), most_frequent(kRoad / 2 + 1, kRoad, kRoad)};
}

void erase(CellArray& cells, double share, double cell_m, Cell no_road, std::mt19937_64& random) {
  std::vector<CellPosition> roads;
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      if (is_road(cells.at(col, row))) roads.push_back({col + 0.5, row + 0.5});
    }
  }
  auto left = std::llround(share * static_cast<double>(roads.size()));
  while (left > 0 && !roads.empty()) {
    const auto pick = static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(roads.size())));
    const CellPosition centre = std::exchange(roads[pick], roads.back());
    roads.pop_back();
    along(cells, centre, centre, kPatchRadiusM / cell_m, [&](Cell& cell) {
      left -= is_road(cell) ? 1 : 0;
      cell = no_road;
    });
  }
}

void invent(CellArray& cells, std::int64_t wanted, double cell_m, Cell road, std::mt19937_64& random) {
  constexpr int kMaxStrokes = 100'000;  // a map full of roads has no room for more
  for (int stroke = 0; wanted > 0 && stroke < kMaxStrokes; ++stroke) {
    const CellPosition a = anywhere(cells, random);
    const double direction = uniform(random, 0.0, kTurn);
    const double length = kStrokeLengthM / cell_m;
    const CellPosition b{a.col + length * std::cos(direction), a.row + length * std::sin(direction)};
    along(cells, a, b, kStrokeWidthM / 2.0 / cell_m, [&](Cell& cell) {
      wanted -= is_road(cell) ? 0 : 1;
      cell = road;
    });
  }
}

void block(CellArray& cells, double share, std::mt19937_64& random) {
  const auto wanted = std::llround(share * static_cast<double>(cells.observed_count()));
  std::int64_t hidden = 0;
  constexpr int kMaxDiscs = 1000;
  for (int disc = 0; hidden < wanted && disc < kMaxDiscs; ++disc) {
    const double radius = uniform(random, 0.05, 0.2) * std::min(cells.cols(), cells.rows());
    const CellPosition centre = anywhere(cells, random);
    along(cells, centre, centre, radius, [&](Cell& cell) {
      cell = kUnobserved;
      ++hidden;
    });
  }
}

/// What a rectification with a wrong scale and tilt takes for a metric window of cols x rows cells. Seen from the
/// height H, a tilt t stretches the ground at the distance d ahead of the nadir by about 1 + t d / H.
FeatureMap distorted(const FeatureMap& wide, int cols, int rows, double scale, std::pair<double, double> tilt_rad) {
  const double height = std::max(cols, rows);
  CellArray cells(cols, rows);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double right = col + 0.5 - 0.5 * cols;
      const double back = row + 0.5 - 0.5 * rows;
      const double stretch = scale * (1.0 + (tilt_rad.first * right + tilt_rad.second * back) / height);
      cells.at(col, row) = bilinear(wide.cells, {wide.nadir.col + stretch * right, wide.nadir.row + stretch * back});
    }
  }
  return FeatureMap::centred(std::move(cells), wide.cell_m);
}

FeatureMap seen(const RoadGrid& map, const GridPose& pose, int cols, int rows, const FeatureQuality& quality,
                std::mt19937_64& random) {
  const double cell_m = map.geometry.cell_m;
  const double scale = 1.0 + quality.scale * std::clamp(normal_pair(random).first, -3.0, 3.0);
  const auto [across, ahead] = normal_pair(random);
  const double tilt = quality.tilt_deg * std::numbers::pi / 180.0;
  if (quality.scale == 0.0 && quality.tilt_deg == 0.0) return cut_out(map, pose, cols, rows, cell_m);
  constexpr double kMargin = 1.5;
  const FeatureMap wide = cut_out(map, pose, static_cast<int>(std::ceil(kMargin * cols)),
                                  static_cast<int>(std::ceil(kMargin * rows)), cell_m);
  return distorted(wide, cols, rows, std::clamp(scale, 0.7, 1.4), {tilt * across, tilt * ahead});
}

}  // namespace

FeatureMap simulate_features(const RoadGrid& map, const GridPose& pose, int cols, int rows,
                             const FeatureQuality& quality, std::mt19937_64& random) {
  const double cell_m = map.geometry.cell_m;
  const auto [east, north] = normal_pair(random);
  const GridPose shifted{
      {pose.position.east_m + quality.shift_m * east, pose.position.north_m + quality.shift_m * north}, pose.heading};
  FeatureMap features = seen(map, shifted, cols, rows, quality, random);
  const auto true_roads = static_cast<double>(road_cells(features.cells));
  const UsualCells usual_cells = usual(features.cells);
  erase(features.cells, quality.erase, cell_m, usual_cells.no_road, random);
  invent(features.cells, std::llround(quality.invent * true_roads), cell_m, usual_cells.road, random);
  block(features.cells, quality.block, random);
  return features;
}

}  // namespace roadfix
