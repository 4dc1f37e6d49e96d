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

/// A stripe and the length of road in it.
struct Line {
  Stripe stripe;
  double length = 0.0;
};

/// Of the stripes like `first` that begin less than `reach` beyond it the one that holds most road.
Line longest_of_direction(const std::vector<RoadPiece>& pieces, const Stripe& first, double reach) {
  constexpr int kBins = 4;  // of a stripe
  const double bin = first.width / kBins;
  std::vector<double> lengths(static_cast<std::size_t>(reach / bin) + 1 + kBins, 0.0);
  for (const RoadPiece& piece : pieces) {
    const double bins = (first.distance(piece) - first.from) / bin;
    if (bins < 0.0 || bins >= static_cast<double>(lengths.size())) continue;
    lengths[static_cast<std::size_t>(bins)] += piece.length;
  }
  Line longest{first};
  for (std::size_t i = 0; i + kBins < lengths.size(); ++i) {
    const double length = std::accumulate(lengths.data() + i, lengths.data() + i + kBins, 0.0);
    if (length <= longest.length) continue;
    longest = {first, length};
    longest.stripe.from += static_cast<double>(i) * bin;
  }
  return longest;
}

/// The one that holds most road, by Hough's transform. `reach`: no piece is farther from the origin.
Line longest_line(const std::vector<RoadPiece>& pieces, double width, double reach) {
  constexpr int kDirections = 180;
  Line longest{{.width = width}};
  for (int i = 0; i < kDirections; ++i) {
    const double angle = i * std::numbers::pi / kDirections;
    const Line line = longest_of_direction(pieces, {std::cos(angle), std::sin(angle), -reach, width}, 2.0 * reach);
    if (line.length > longest.length) longest = line;
  }
  return longest;
}

/// What lies beside the longest straight road, with its other carriageway if there is one.
void take_longest_away(std::vector<RoadPiece>& pieces, const StraightRoad& straight, double reach) {
  constexpr double kMinShareOfOther = 0.5;
  const auto take_away = [&](const Stripe& stripe) {
    std::erase_if(pieces, [&](const RoadPiece& piece) { return stripe.holds(piece); });
  };
  const Line longest = longest_line(pieces, straight.width, reach);
  take_away(longest.stripe);
  Stripe beside = longest.stripe;
  beside.from -= straight.apart;
  const Line other = longest_of_direction(pieces, beside, 2.0 * straight.apart);
  if (other.length > kMinShareOfOther * longest.length) take_away(other.stripe);
}

}  // namespace

double road_beside_straight_ones(const CellArray& map, const CellArray& features, int straight_roads,
                                 const StraightRoad& straight, double narrowest) {
  assert(map.cols() == features.cols() && map.rows() == features.rows());
  std::vector<RoadPiece> pieces = pieces_of(shared_road(map, features), narrowest);
  for (int road = 0; road < straight_roads; ++road) {
    take_longest_away(pieces, straight, std::hypot(map.cols(), map.rows()));
  }
  double length = 0.0;
  for (const RoadPiece& piece : pieces) length += piece.length;
  return length;
}

}  // namespace roadfix
