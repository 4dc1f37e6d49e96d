#include "tiles/sources/line_coverage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace roadfix {
namespace {

constexpr int kSubcells = 8;  // a side
using Position = GridGeometry::CellPosition;

/// Part of a horizontal line; grows to hold what is added.
struct Interval {
  double first = std::numeric_limits<double>::infinity();
  double last = -std::numeric_limits<double>::infinity();
  void add(double x) {
    first = std::min(first, x);
    last = std::max(last, x);
  }
};

void add_disc(Interval& interval, Position centre, double radius, double y) {
  const double square = radius * radius - (y - centre.row) * (y - centre.row);
  if (square < 0.0) return;
  interval.add(centre.col - std::sqrt(square));
  interval.add(centre.col + std::sqrt(square));
}

void add_edge(Interval& interval, Position a, Position b, double y) {
  if ((a.row > y) == (b.row > y)) return;
  interval.add(a.col + (y - a.row) / (b.row - a.row) * (b.col - a.col));
}

/// Where the line y crosses all that lies within `radius` of the segment: a convex shape, hence one interval.
Interval across(Position a, Position b, double radius, double y) {
  Interval interval;
  add_disc(interval, a, radius, y);
  add_disc(interval, b, radius, y);
  const double length = std::hypot(b.col - a.col, b.row - a.row);
  if (length > 0.0) {
    const Position side{-(b.row - a.row) / length * radius, (b.col - a.col) / length * radius};
    const std::array<Position, 4> corners{
        Position{a.col + side.col, a.row + side.row}, Position{b.col + side.col, b.row + side.row},
        Position{b.col - side.col, b.row - side.row}, Position{a.col - side.col, a.row - side.row}};
    for (std::size_t i = 0; i < corners.size(); ++i) add_edge(interval, corners[i], corners[(i + 1) % 4], y);
  }
  return interval;
}

}  // namespace

LineCoverage::LineCoverage(const GridGeometry& block)
    : block_(block), samples_(static_cast<std::size_t>(block.cols) * static_cast<std::size_t>(block.rows), 0) {}

void LineCoverage::add(GridPoint from, GridPoint to, double half_width_m) {
  const Position a = block_.position_of(from);
  const Position b = block_.position_of(to);
  const double radius = half_width_m / block_.cell_m;
  const double top = std::max(0.0, std::min(a.row, b.row) - radius);
  const double bottom = std::min(static_cast<double>(block_.rows), std::max(a.row, b.row) + radius);
  if (!(top <= bottom)) return;
  const int first = std::max(0, static_cast<int>(std::floor(top * kSubcells)));
  const int last = std::min(block_.rows * kSubcells - 1, static_cast<int>(std::ceil(bottom * kSubcells)));
  for (int sample_row = first; sample_row <= last; ++sample_row) {
    const Interval interval = across(a, b, radius, (sample_row + 0.5) / kSubcells);
    add_row(sample_row, interval.first, interval.last);
  }
}

void LineCoverage::add_row(int sample_row, double first, double last) {
  const double from = std::max(0.0, std::ceil(first * kSubcells - 0.5));
  const double to = std::min(block_.cols * kSubcells - 1.0, std::floor(last * kSubcells - 0.5));
  if (!(from <= to)) return;
  const auto begin = static_cast<int>(from);
  const auto end = static_cast<int>(to);
  const auto base = static_cast<std::size_t>(sample_row / kSubcells) * static_cast<std::size_t>(block_.cols);
  const int shift = sample_row % kSubcells * kSubcells;
  for (int col = begin / kSubcells; col <= end / kSubcells; ++col) {
    const int low = std::max(begin - col * kSubcells, 0);
    const int high = std::min(end - col * kSubcells, kSubcells - 1);
    const std::uint64_t bits = (0xFFULL >> (kSubcells - 1 - high)) & (0xFFULL << low);
    samples_[base + static_cast<std::size_t>(col)] |= (bits & 0xFFULL) << shift;
  }
}

double LineCoverage::share(int col, int row) const {
  const auto index =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(block_.cols) + static_cast<std::size_t>(col);
  return std::popcount(samples_[index]) / static_cast<double>(kSubcells * kSubcells);
}

}  // namespace roadfix
