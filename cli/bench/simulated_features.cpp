#include "cli/bench/simulated_features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core/types.hpp>
#include <utility>
#include <vector>

#include "core/grid/resample.hpp"

namespace roadfix::bench {
namespace {

constexpr double kPatchRadiusM = 12.0;
constexpr double kStrokeLengthM = 60.0;
constexpr double kStrokeWidthM = 8.0;

bool is_road(Cell cell) { return is_observed(cell) && cell > kRoad / 2; }

std::ptrdiff_t road_cells(const CellArray& cells) { return std::ranges::count_if(cells.cells(), is_road); }

/// Calls `visit(cell)` for each observed cell within `radius` cells of the segment a-b.
template <typename Visit>
void along(CellArray& cells, cv::Point2d a, cv::Point2d b, double radius, Visit visit) {
  const cv::Point2d d = b - a;
  const double length2 = std::max(d.dot(d), 1e-12);
  const int first_row = std::max(0, static_cast<int>(std::min(a.y, b.y) - radius));
  const int last_row = std::min(cells.rows() - 1, static_cast<int>(std::max(a.y, b.y) + radius));
  const int first_col = std::max(0, static_cast<int>(std::min(a.x, b.x) - radius));
  const int last_col = std::min(cells.cols() - 1, static_cast<int>(std::max(a.x, b.x) + radius));
  for (int row = first_row; row <= last_row; ++row) {
    for (int col = first_col; col <= last_col; ++col) {
      const cv::Point2d p(col + 0.5, row + 0.5);
      const double t = std::clamp((p - a).dot(d) / length2, 0.0, 1.0);
      const cv::Point2d off = p - (a + t * d);
      if (off.dot(off) <= radius * radius && is_observed(cells.at(col, row))) visit(cells.at(col, row));
    }
  }
}

cv::Point2d anywhere(const CellArray& cells, Random& random) {
  return {uniform(random, 0.0, cells.cols()), uniform(random, 0.0, cells.rows())};
}

void erase(CellArray& cells, double share, double cell_m, Random& random) {
  std::vector<cv::Point2d> roads;
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      if (is_road(cells.at(col, row))) roads.emplace_back(col + 0.5, row + 0.5);
    }
  }
  auto left = std::llround(share * static_cast<double>(roads.size()));
  while (left > 0 && !roads.empty()) {
    const auto pick = static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(roads.size())));
    const cv::Point2d centre = std::exchange(roads[pick], roads.back());
    roads.pop_back();
    along(cells, centre, centre, kPatchRadiusM / cell_m, [&](Cell& cell) {
      left -= is_road(cell) ? 1 : 0;
      cell = kNoRoad;
    });
  }
}

void invent(CellArray& cells, std::int64_t wanted, double cell_m, Random& random) {
  constexpr int kMaxStrokes = 100'000;  // a map full of roads has no room for more
  for (int stroke = 0; wanted > 0 && stroke < kMaxStrokes; ++stroke) {
    const cv::Point2d a = anywhere(cells, random);
    const double direction = uniform(random, 0.0, 2.0 * std::numbers::pi);
    const cv::Point2d b = a + (kStrokeLengthM / cell_m) * cv::Point2d(std::cos(direction), std::sin(direction));
    along(cells, a, b, kStrokeWidthM / 2.0 / cell_m, [&](Cell& cell) {
      wanted -= is_road(cell) ? 0 : 1;
      cell = kRoad;
    });
  }
}

GridPoint shifted(GridPoint point, double sigma_m, Random& random) {
  // Box and Muller: std::normal_distribution differs between standard libraries.
  const double radius = sigma_m * std::sqrt(-2.0 * std::log(1.0 - uniform(random, 0.0, 1.0)));
  const double direction = uniform(random, 0.0, 2.0 * std::numbers::pi);
  return {point.east_m + radius * std::cos(direction), point.north_m + radius * std::sin(direction)};
}

}  // namespace

FeatureMap simulate_features(const RoadGrid& map, const GridPose& pose, const Footprint& footprint,
                             const FeatureNoise& noise, Random& random) {
  const double cell_m = map.geometry.cell_m;
  const GridPose seen{shifted(pose.position, noise.shift_m, random), pose.heading};
  FeatureMap features = cut_out(map, seen, static_cast<int>(std::lround(footprint.width_m / cell_m)),
                                static_cast<int>(std::lround(footprint.height_m / cell_m)), cell_m);
  const auto true_roads = static_cast<double>(road_cells(features.cells));
  erase(features.cells, noise.erase, cell_m, random);
  invent(features.cells, std::llround(noise.invent * true_roads), cell_m, random);
  return features;
}

}  // namespace roadfix::bench
