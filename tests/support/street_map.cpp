#include "tests/support/street_map.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/units/draws.hpp"

namespace roadfix::testing {
namespace {

struct Start {
  double heading, row, col;
};

/// Draws of one call would come in the order that the compiler likes; those in braces come as they stand.
Start any_start(std::mt19937_64& random, int cols, int rows) {
  return {uniform(random, 0, 6.283), uniform(random, 0, rows), uniform(random, 0, cols)};
}

/// Walks a road over the cells; unit: cells.
class Brush {
 public:
  Brush(CellArray& cells, double width) : cells_(cells), radius_(0.5 * width) {}

  void dab(double col, double row) {
    const int reach = static_cast<int>(std::ceil(radius_));
    const int c0 = static_cast<int>(std::floor(col));
    const int r0 = static_cast<int>(std::floor(row));
    for (int r = r0 - reach; r <= r0 + reach; ++r) {
      for (int c = c0 - reach; c <= c0 + reach; ++c) {
        if (cells_.contains(c, r) && std::hypot(c + 0.5 - col, r + 0.5 - row) <= radius_) cells_.at(c, r) = kRoad;
      }
    }
  }

  /// `bend` radians of random turning per cell.
  std::vector<std::pair<double, double>> walk(std::mt19937_64& random, Start start, double length, double bend) {
    auto [heading, row, col] = start;
    std::vector<std::pair<double, double>> trace;
    double turn = 0.0;
    for (double done = 0.0; done < length; done += 0.5) {
      dab(col, row);
      trace.emplace_back(col, row);
      turn = 0.98 * turn + uniform(random, -bend, bend);
      heading += 0.5 * turn;
      col += 0.5 * std::cos(heading);
      row += 0.5 * std::sin(heading);
    }
    return trace;
  }

 private:
  CellArray& cells_;
  double radius_;
};

/// Aligned to cells of twice the size.
RoadGrid halved(const RoadGrid& grid) {
  const GridGeometry coarse = GridGeometry::covering(grid.geometry.box(), 2.0 * grid.geometry.cell_m);
  CellArray aligned(2 * coarse.cols, 2 * coarse.rows);
  paste(grid.cells, aligned, grid.geometry.origin.col - 2 * coarse.origin.col,
        grid.geometry.origin.row - 2 * coarse.origin.row);
  return {coarse, roadfix::halved(aligned)};
}

}  // namespace

RoadGrid street_map(std::uint64_t seed, const GridGeometry& geometry) {
  std::mt19937_64 random(seed);
  RoadGrid map{geometry, CellArray(geometry.cols, geometry.rows, kNoRoad)};
  const double metre = 1.0 / geometry.cell_m;
  const double area_km2 = geometry.cols * geometry.cell_m * geometry.rows * geometry.cell_m * 1e-6;
  const auto main_roads = static_cast<int>(std::ceil(6.0 * area_km2)) + 2;
  std::vector<std::pair<double, double>> junctions;
  for (int i = 0; i < main_roads; ++i) {
    Brush brush(map.cells, 9.0 * metre);
    const auto trace =
        brush.walk(random, any_start(random, geometry.cols, geometry.rows), 1500.0 * metre, 0.004 / metre);
    junctions.insert(junctions.end(), trace.begin(), trace.end());
  }
  const auto streets = static_cast<int>(std::ceil(70.0 * area_km2)) + 4;
  for (int i = 0; i < streets; ++i) {
    const auto [col, row] = junctions[random() % junctions.size()];
    Brush brush(map.cells, 6.0 * metre);
    const double length = uniform(random, 60.0, 350.0) * metre;
    const auto trace = brush.walk(random, {uniform(random, 0, 6.283), row, col}, length, 0.002 / metre);
    junctions.insert(junctions.end(), trace.begin(), trace.end());
  }
  return map;
}

RoadGrid grid_city(const GridGeometry& geometry, double block_m) {
  RoadGrid map{geometry, CellArray(geometry.cols, geometry.rows, kNoRoad)};
  const auto on_street = [&](int cell) { return std::fmod((cell + 0.5) * geometry.cell_m, block_m) < 6.0; };
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      if (on_street(col) || on_street(row)) map.cells.at(col, row) = kRoad;
    }
  }
  return map;
}

FeatureMap observed_at(const RoadGrid& map, const GridPose& pose, int cols, int rows, double cell_m,
                       const DetectorNoise& noise, std::mt19937_64& random) {
  FeatureMap features = cut_out(map, pose, cols, rows, cell_m);
  CellArray& cells = features.cells;
  const auto road_cells = static_cast<double>(std::ranges::count_if(cells.cells(), is_road));
  const double patch = 30.0 / cell_m;
  const double patches = noise.erase * cols * rows / (patch * patch);
  for (int i = 0; i < static_cast<int>(std::ceil(patches)); ++i) {
    const double left = uniform(random, -patch / 2, cols - patch / 2);
    const double top = uniform(random, -patch / 2, rows - patch / 2);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        const bool inside = c >= left && c < left + patch && r >= top && r < top + patch;
        if (inside && is_observed(cells.at(c, r))) cells.at(c, r) = kNoRoad;
      }
    }
  }
  CellArray invented(cols, rows, kNoRoad);
  Brush brush(invented, 6.0 / cell_m);
  const double length = noise.invent * road_cells / (6.0 / cell_m);
  for (double done = 0.0; done < length; done += 60.0 / cell_m) {
    brush.walk(random, any_start(random, cols, rows), 60.0 / cell_m, 0.0);
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      if (is_road(invented.at(c, r)) && is_observed(cells.at(c, r))) cells.at(c, r) = kRoad;
    }
  }
  return features;
}

std::function<RoadGrid(const GridGeometry&)> reader_of(const RoadGrid& map) {
  auto levels = std::make_shared<std::vector<RoadGrid>>();
  levels->push_back(map);
  while (levels->back().geometry.cell_m < 4096.0) levels->push_back(halved(levels->back()));
  return [levels](const GridGeometry& geometry) {
    for (const RoadGrid& level : *levels) {
      if (level.geometry.cell_m != geometry.cell_m) continue;
      RoadGrid window = RoadGrid::unobserved(geometry);
      paste(level.cells, window.cells, level.geometry.origin.col - geometry.origin.col,
            level.geometry.origin.row - geometry.origin.row);
      return window;
    }
    throw std::invalid_argument("no level of that cell size");
  };
}

}  // namespace roadfix::testing
