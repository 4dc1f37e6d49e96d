#include "tiles/roads/line_coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadfix {
namespace {

constexpr int kSubcells = 8;  // a side
static_assert(kSubcells * kSubcells == LineCoverage::kSamples);
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

/// All that lies within `radius` of the segment: a convex shape.
class Capsule {
 public:
  Capsule(Position a, Position b, double radius) : a_(a), b_(b), radius_(radius) {
    const double length = std::hypot(b.col - a.col, b.row - a.row);
    if (length <= 0.0) return;
    const Position side{-(b.row - a.row) / length * radius, (b.col - a.col) / length * radius};
    corners_ = {Position{a.col + side.col, a.row + side.row}, Position{b.col + side.col, b.row + side.row},
                Position{b.col - side.col, b.row - side.row}, Position{a.col - side.col, a.row - side.row}};
  }

  /// Where the line y crosses it: one interval.
  Interval across(double y) const {
    Interval interval;
    add_disc(interval, a_, radius_, y);
    add_disc(interval, b_, radius_, y);
    for (std::size_t i = 0; i < corners_.size(); ++i) add_edge(interval, corners_[i], corners_[(i + 1) % 4], y);
    return interval;
  }

 private:
  Position a_;
  Position b_;
  double radius_;
  /// Of the rectangle between the discs. Those of a point are all alike: no line crosses its edges.
  std::array<Position, 4> corners_{};
};

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
  const Capsule capsule(a, b, radius);
  for (int sample_row = first; sample_row <= last; ++sample_row) {
    const Interval interval = capsule.across((sample_row + 0.5) / kSubcells);
    add_row(sample_row, interval.first, interval.last);
  }
}

void LineCoverage::add_row(int sample_row, double first, double last) {
  const double from = std::max(0.0, std::ceil(first * kSubcells - 0.5));
  const double to = std::min(block_.cols * kSubcells - 1.0, std::floor(last * kSubcells - 0.5));
  if (!(from <= to)) return;
  const auto begin = static_cast<int>(from);
  const auto end = static_cast<int>(to);
  const int shift = sample_row % kSubcells * kSubcells;
  for (int col = begin / kSubcells; col <= end / kSubcells; ++col) {
    const int low = std::max(begin - col * kSubcells, 0);
    const int high = std::min(end - col * kSubcells, kSubcells - 1);
    const std::uint64_t bits = (0xFFULL >> (kSubcells - 1 - high)) & (0xFFULL << low);
    samples_[index(col, sample_row / kSubcells)] |= (bits & 0xFFULL) << shift;
  }
}

}  // namespace roadfix
