#include "core/search/shared_road.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace roadfix {
namespace {

/// What each cell adds to the correlation: the product of what map and features lie above their means over the cells
/// observed in both, 0 unless both do.
std::vector<double> contributions(const CellArray& map, const CellArray& features) {
  const auto for_each_in_both = [&](auto use) {
    for (std::size_t i = 0; i < map.cells().size(); ++i) {
      const Cell m = map.cells()[i];
      const Cell l = features.cells()[i];
      if (is_observed(m) && is_observed(l)) use(i, probability(m), probability(l));
    }
  };
  double n = 0.0;
  double sum_m = 0.0;
  double sum_l = 0.0;
  for_each_in_both([&](std::size_t, double m, double l) {
    n += 1.0;
    sum_m += m;
    sum_l += l;
  });
  std::vector<double> result(map.cells().size(), 0.0);
  for_each_in_both([&](std::size_t i, double m, double l) {
    result[i] = std::max(0.0, m - sum_m / n) * std::max(0.0, l - sum_l / n);
  });
  return result;
}

/// Road where a cell contributes at least half as much as those do that the correlation rests on: of roads that are
/// alike sure all of them, and of their soft edges the inner half.
CellArray shared_road(const CellArray& map, const CellArray& features) {
  const std::vector<double> added = contributions(map, features);
  double sum = 0.0;
  double squares = 0.0;
  for (const double w : added) {
    sum += w;
    squares += w * w;
  }
  CellArray road(map.cols(), map.rows(), kNoRoad);
  if (sum <= 0.0) return road;
  const double least = 0.5 * squares / sum;
  std::ranges::transform(added, road.cells().begin(), [&](double w) { return w >= least ? kRoad : kNoRoad; });
  return road;
}

struct Step {
  int cols;
  int rows;
};

/// No road is wider along the nearest of these than by a twelfth.
constexpr std::array<Step, 4> kAcross{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};

/// Road cells from this one on along a direction.
int run_of(const CellArray& road, int col, int row, Step step) {
  int cells = 0;
  while (is_road(road.get(col + cells * step.cols, row + cells * step.rows))) ++cells;
  return cells;
}

/// Of each road cell the width of the road there: its shortest run along rows, columns and diagonals.
std::vector<double> widths_of(const CellArray& road) {
  std::vector<double> widths(road.cells().size(), std::numeric_limits<double>::infinity());
  const auto index = [&](int col, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(road.cols()) + static_cast<std::size_t>(col);
  };
  for (const Step step : kAcross) {
    const double side = std::hypot(step.cols, step.rows);
    for (int row = 0; row < road.rows(); ++row) {
      for (int col = 0; col < road.cols(); ++col) {
        if (is_road(road.get(col - step.cols, row - step.rows))) continue;
        const int run = run_of(road, col, row, step);
        for (int i = 0; i < run; ++i) {
          double& width = widths[index(col + i * step.cols, row + i * step.rows)];
          width = std::min(width, run * side);
        }
      }
    }
  }
  return widths;
}

/// A cell of road, by its centre.
struct RoadPiece {
  double x;
  double y;
  double length;
};

std::vector<RoadPiece> pieces_of(const CellArray& road, double narrowest) {
  const std::vector<double> widths = widths_of(road);
  std::vector<RoadPiece> pieces;
  std::size_t i = 0;
  for (int row = 0; row < road.rows(); ++row) {
    for (int col = 0; col < road.cols(); ++col, ++i) {
      if (is_road(road.at(col, row))) pieces.push_back({1.0 * col, 1.0 * row, 1.0 / std::max(widths[i], narrowest)});
    }
  }
  return pieces;
}

/// The points whose distance from the origin along the normal is in [from, from + width).
struct Stripe {
  double normal_x = 1.0;
  double normal_y = 0.0;
  double from = 0.0;
  double width = 0.0;

  double distance(const RoadPiece& piece) const { return piece.x * normal_x + piece.y * normal_y; }
  bool holds(const RoadPiece& piece) const {
    const double beyond = distance(piece) - from;
    return beyond >= 0.0 && beyond < width;
  }
};

/// The one that holds most road, by Hough's transform. `reach`: no piece is farther from the origin.
Stripe longest_line(const std::vector<RoadPiece>& pieces, double width, double reach) {
  constexpr int kDirections = 180;
  constexpr int kBins = 4;  // of a stripe
  const double bin = width / kBins;
  const auto bins = static_cast<std::size_t>(2.0 * reach / bin) + 1;
  Stripe longest{.width = width};
  double most = 0.0;
  std::vector<double> lengths;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = i * std::numbers::pi / kDirections;
    const Stripe direction{std::cos(angle), std::sin(angle), -reach, width};
    lengths.assign(bins + kBins, 0.0);
    for (const RoadPiece& piece : pieces) {
      lengths[static_cast<std::size_t>((direction.distance(piece) + reach) / bin)] += piece.length;
    }
    for (std::size_t first = 0; first < bins; ++first) {
      const double length = std::accumulate(lengths.data() + first, lengths.data() + first + kBins, 0.0);
      if (length <= most) continue;
      most = length;
      longest = direction;
      longest.from += static_cast<double>(first) * bin;
    }
  }
  return longest;
}

}  // namespace

double road_beside_lines(const CellArray& map, const CellArray& features, int lines, double narrowest,
                         double line_width) {
  assert(map.cols() == features.cols() && map.rows() == features.rows());
  std::vector<RoadPiece> pieces = pieces_of(shared_road(map, features), narrowest);
  for (int line = 0; line < lines; ++line) {
    const Stripe stripe = longest_line(pieces, line_width, std::hypot(map.cols(), map.rows()));
    std::erase_if(pieces, [&](const RoadPiece& piece) { return stripe.holds(piece); });
  }
  double length = 0.0;
  for (const RoadPiece& piece : pieces) length += piece.length;
  return length;
}

}  // namespace roadfix
