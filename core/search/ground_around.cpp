#include "core/search/ground_around.hpp"

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
  const int reach = level.reach(std::min(pose.scale_step + 1, level.scales.reach())) + cells;
  return GridGeometry{level.cell_m(), pose.cell, 1, 1}.padded(reach);
}

std::vector<PlaneCell> places_around(PlaneCell place, int reach, int step) {
  std::vector<PlaneCell> places;
  for (int row = -reach; row <= reach; ++row) {
    for (int col = -reach; col <= reach; ++col) places.push_back({place.col + col * step, place.row + row * step});
  }
  return places;
}

GroundAround::GroundAround(const Level& level, GroundUse use, const Deadline& deadline,
                           const std::vector<LatticePose>& poses) {
  std::vector<GridGeometry> windows;
  std::int64_t apart = 0;
  for (const LatticePose& pose : poses) {
    windows.push_back(window_around(level, pose, use.cells));
    apart += cells_of(windows.back());
  }
  bool rotated = false;
  if (!windows.empty()) {
    const GridGeometry all = std::accumulate(windows.begin() + 1, windows.end(), windows.front(), joined);
    if (cells_of(all) <= apart) {
      // Three of four headings need no footprint of their own then.
      const bool in_quarters = level.bins.count() % 4 == 0;
      rotated = in_quarters && worth_rotating(all, level.reach(level.scales.reach()), 0.75 * use.headings);
      windows.assign(1, all);
    }
  }
  for (const GridGeometry& window : windows) {
    if (deadline.over()) return;
    planes_.push_back({window.origin, QuarterPlanes(level.read(window).cells, rotated)});
  }
  complete_ = true;
}

void GroundAround::match(const PackedFootprint& footprint, int quarters, std::span<const std::size_t> poses,
                         std::span<const LatticeIndex> cells, std::span<MatchSums> sums) const {
  std::vector<PlaneCell> places;
  places.reserve(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Plane& below = at(poses[i]);
    places.push_back(
        below.quarters.place({cells[i].col - below.origin.col, cells[i].row - below.origin.row}, quarters));
  }
  for (std::size_t first = 0; first < places.size();) {
    std::size_t last = shared() ? places.size() : first + 1;
    while (last < places.size() && poses[last] == poses[first]) ++last;
    match_sums(at(poses[first]).quarters.plane(quarters), footprint, std::span(places).subspan(first, last - first),
               sums.subspan(first, last - first));
    first = last;
  }
}

}  // namespace roadfix
