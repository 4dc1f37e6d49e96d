#include "tiles/sources/plane_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadfix {

PlanePolygon::PlanePolygon(std::vector<GridPoint> outer, std::vector<std::vector<GridPoint>> holes)
    : rings_(std::move(holes)), box_{outer.front(), outer.front()} {
  rings_.insert(rings_.begin(), std::move(outer));
  for (const GridPoint& p : rings_.front()) {
    box_.min = {std::min(box_.min.east_m, p.east_m), std::min(box_.min.north_m, p.north_m)};
    box_.max = {std::max(box_.max.east_m, p.east_m), std::max(box_.max.north_m, p.north_m)};
  }
}

void PlanePolygon::mark(const GridGeometry& block, std::vector<bool>& inside) const {
  std::vector<double> crossings;
  for (int row = 0; row < block.rows; ++row) {
    const double north = block.cell_center(0, row).north_m;
    if (north < box_.min.north_m || north > box_.max.north_m) continue;
    crossings.clear();
    for (const std::vector<GridPoint>& ring : rings_) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const GridPoint a = ring[i];
        const GridPoint b = ring[(i + 1) % ring.size()];
        if ((a.north_m > north) == (b.north_m > north)) continue;
        crossings.push_back(a.east_m + (north - a.north_m) / (b.north_m - a.north_m) * (b.east_m - a.east_m));
      }
    }
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      // Cell centres at or right of the first crossing and left of the second, so that neighbours share no cell.
      const double first = std::ceil(crossings[i] / block.cell_m - 0.5 - block.origin.col);
      const double last = std::ceil(crossings[i + 1] / block.cell_m - 0.5 - block.origin.col) - 1.0;
      const auto begin = static_cast<int>(std::clamp(first, 0.0, static_cast<double>(block.cols)));
      const auto end = static_cast<int>(std::clamp(last, -1.0, block.cols - 1.0));
      for (int col = begin; col <= end; ++col) {
        inside[static_cast<std::size_t>(row) * static_cast<std::size_t>(block.cols) + static_cast<std::size_t>(col)] =
            true;
      }
    }
  }
}

}  // namespace roadfix
