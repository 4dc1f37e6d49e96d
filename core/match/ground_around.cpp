#include "core/match/ground_around.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace roadfix {
namespace {

std::int64_t cells_of(const GridGeometry& window) { return std::int64_t{window.cols} * window.rows; }

GridGeometry joined(const GridGeometry& a, const GridGeometry& b) {
  const LatticeIndex first{std::min(a.origin.col, b.origin.col), std::min(a.origin.row, b.origin.row)};
  return {a.cell_m, first, std::max(a.origin.col + a.cols, b.origin.col + b.cols) - first.col,
          std::max(a.origin.row + a.rows, b.origin.row + b.rows) - first.row};
}

}  // namespace

GridGeometry window_around(const Level& level, const LatticePose& pose, int cells) {
  const int reach = level.reach(std::min(pose.scale + 1, level.scales.reach())) + cells;
  return GridGeometry{level.cell_m(), pose.cell, 1, 1}.padded(reach);
}

std::vector<PlaneCell> places_around(PlaneCell place, int reach, int step) {
  std::vector<PlaneCell> places;
  for (int row = -reach; row <= reach; ++row) {
    for (int col = -reach; col <= reach; ++col) places.push_back({place.col + col * step, place.row + row * step});
  }
  return places;
}

GroundAround::GroundAround(const Level& level, int cells, const Deadline& deadline,
                           const std::vector<LatticePose>& poses) {
  std::vector<GridGeometry> windows;
  std::int64_t apart = 0;
  for (const LatticePose& pose : poses) {
    windows.push_back(window_around(level, pose, cells));
    apart += cells_of(windows.back());
  }
  if (!windows.empty()) {
    const GridGeometry all = std::accumulate(windows.begin() + 1, windows.end(), windows.front(), joined);
    if (cells_of(all) <= apart) windows.assign(1, all);
  }
  for (const GridGeometry& window : windows) {
    if (deadline.over()) return;
    planes_.push_back({window.origin, MapPlane(level.read(window).cells)});
  }
  complete_ = true;
}

PlaneCell GroundAround::place(std::size_t pose, LatticeIndex cell) const {
  const LatticeIndex origin = at(pose).origin;
  return {cell.col - origin.col, cell.row - origin.row};
}

void GroundAround::match(const PackedFootprint& footprint, std::span<const std::size_t> poses,
                         std::span<const PlaneCell> places, std::span<MatchSums> sums) const {
  if (poses.empty()) return;
  const std::size_t each = places.size() / poses.size();
  const std::size_t together = shared() ? places.size() : each;
  for (std::size_t first = 0; first < places.size(); first += together) {
    match_sums(at(poses[first / each]).plane, footprint, places.subspan(first, together),
               sums.subspan(first, together));
  }
}

}  // namespace roadfix
