#include "tiles/roads/plane_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace roadfix {

PlanePolygon::PlanePolygon(const std::vector<GridPoint>& outer, const std::vector<std::vector<GridPoint>>& holes)
    : box_(box_around(outer)) {
  add_ring(outer);
  for (const std::vector<GridPoint>& hole : holes) add_ring(hole);
  sort_into_strips();
}

void PlanePolygon::add_ring(const std::vector<GridPoint>& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Edge edge{ring[i], ring[(i + 1) % ring.size()]};
    if (edge.from.north_m != edge.to.north_m) edges_.push_back(edge);
  }
}

/// Strips as high as an edge is on average: then all of them together hold at most three times as many edges as there
/// are, however many reach through several strips.
void PlanePolygon::sort_into_strips() {
  if (edges_.empty()) return;
  double rise_m = 0.0;
  double north_m = edges_.front().from.north_m;
  south_m_ = north_m;
  for (const Edge& edge : edges_) {
    rise_m += std::abs(edge.to.north_m - edge.from.north_m);
    south_m_ = std::min({south_m_, edge.from.north_m, edge.to.north_m});
    north_m = std::max({north_m, edge.from.north_m, edge.to.north_m});
  }
  const double height_m = north_m - south_m_;
  strip_m_ = std::max(rise_m, height_m) / static_cast<double>(edges_.size());
  starts_.assign(static_cast<std::size_t>(height_m / strip_m_) + 2, 0);
  for (const Edge& edge : edges_) {
    const Strips strips = strips_of(edge);
    for (std::size_t i = strips.first; i <= strips.last; ++i) ++starts_[i + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  in_strip_.resize(starts_.back());
  std::vector<std::size_t> next = starts_;
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    const Strips strips = strips_of(edges_[e]);
    for (std::size_t i = strips.first; i <= strips.last; ++i) in_strip_[next[i]++] = e;
  }
}

PlanePolygon::Strips PlanePolygon::strips_between(double south_m, double north_m) const {
  const auto last = static_cast<double>(starts_.size() - 2);
  const auto strip = [&](double at_m) {
    return static_cast<std::size_t>(std::clamp(std::floor((at_m - south_m_) / strip_m_), 0.0, last));
  };
  return {strip(south_m), strip(north_m)};
}

PlanePolygon::Strips PlanePolygon::strips_of(const Edge& edge) const {
  const auto [south_m, north_m] = std::minmax(edge.from.north_m, edge.to.north_m);
  return strips_between(south_m, north_m);
}

void PlanePolygon::add_crossings(const Edge& edge, const GridGeometry& block, std::vector<Crossing>& found) const {
  const GridPoint a = edge.from;
  const GridPoint b = edge.to;
  const auto [south_m, north_m] = std::minmax(a.north_m, b.north_m);
  // A row more on either side: which rows are crossed is decided by the northings of their middles, not by a division.
  const auto row_of = [&](double at_m) {
    return static_cast<int>(
        std::clamp(std::floor(-at_m / block.cell_m) - block.origin.row, -1.0, static_cast<double>(block.rows)));
  };
  const int last = std::min(block.rows - 1, row_of(south_m) + 1);
  for (int row = std::max(0, row_of(north_m) - 1); row <= last; ++row) {
    const double north = block.cell_center(0, row).north_m;
    if (north < box_.min.north_m || north > box_.max.north_m) continue;
    if ((a.north_m > north) == (b.north_m > north)) continue;
    found.push_back({row, a.east_m + (north - a.north_m) / (b.north_m - a.north_m) * (b.east_m - a.east_m)});
  }
}

std::vector<PlanePolygon::Crossing> PlanePolygon::crossings(const GridGeometry& block) const {
  std::vector<Crossing> found;
  if (edges_.empty()) return found;
  const GridBox box = block.box();
  const Strips near = strips_between(box.min.north_m, box.max.north_m);
  for (std::size_t strip = near.first; strip <= near.last; ++strip) {
    for (std::size_t i = starts_[strip]; i < starts_[strip + 1]; ++i) {
      const Edge& edge = edges_[in_strip_[i]];
      // An edge through several strips is looked at in the first of them.
      if (std::max(strips_of(edge).first, near.first) == strip) add_crossings(edge, block, found);
    }
  }
  std::ranges::sort(found, {}, [](const Crossing& c) { return std::tuple(c.row, c.east_m); });
  return found;
}

void PlanePolygon::fill(const GridGeometry& block, Cell value, CellArray& cells) const {
  const std::vector<Crossing> found = crossings(block);  // an even number in each row
  for (std::size_t i = 0; i + 1 < found.size(); i += 2) {
    // Cell centres at or right of the first crossing and left of the second, so that neighbours share no cell.
    const double first = std::ceil(found[i].east_m / block.cell_m - 0.5 - block.origin.col);
    const double last = std::ceil(found[i + 1].east_m / block.cell_m - 0.5 - block.origin.col) - 1.0;
    const auto begin = static_cast<int>(std::clamp(first, 0.0, static_cast<double>(block.cols)));
    const auto end = static_cast<int>(std::clamp(last, -1.0, block.cols - 1.0));
    const auto row = cells.row(found[i].row);
    std::fill(row.begin() + begin, row.begin() + end + 1, value);
  }
}

}  // namespace roadfix
