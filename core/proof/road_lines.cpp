#include "core/proof/road_lines.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

namespace roadfix {
namespace {

/// The direction in which most of a line around the cell is there, at least `min_share` of it.
std::optional<int> best_direction(const RoadRemainder& rest, CellOffset at, int level, double min_share) {
  std::optional<int> best;
  double best_share = min_share;
  for (int i = 0; i < kLineDirections; ++i) {
    const auto& line = line_stencil(i);
    const double share = static_cast<double>(rest.share(line, at, level)) / (level * static_cast<double>(line.size()));
    if (share < best_share) continue;
    best = i;
    best_share = share;
  }
  return best;
}

}  // namespace

RoadRemainder::RoadRemainder(const CellArray& cells, int base) : cols_(cells.cols()), rows_(cells.rows()) {
  values_.reserve(cells.cells().size());
  for (const Cell cell : cells.cells()) values_.push_back(is_observed(cell) ? std::max(0, cell - base) : 0);
}

int RoadRemainder::highest() const { return values_.empty() ? 0 : *std::ranges::max_element(values_); }

int RoadRemainder::share(const std::vector<CellOffset>& piece, CellOffset place, int level) const {
  int sum = 0;
  for (const CellOffset cell : piece) sum += std::min(level, at(place.col + cell.col, place.row + cell.row));
  return sum;
}

void RoadRemainder::take(const std::vector<CellOffset>& piece, CellOffset place, int level) {
  for (const CellOffset cell : piece) {
    const int col = place.col + cell.col;
    const int row = place.row + cell.row;
    if (contains(col, row)) values_[index(col, row)] = std::max(0, values_[index(col, row)] - level);
  }
}

LineHints find_lines(const FeatureMap& features, int base) {
  RoadRemainder rest(features.cells, base);
  LineHints hints;
  hints.level = std::max(1, rest.highest() / 3);
  // Whole lines first: broken ones would cut into them.
  for (const double min_share : {0.95, 0.85, 0.75, 0.65, 0.5, 0.4}) {
    for (int row = 0; row < rest.rows(); ++row) {
      for (int col = 0; col < rest.cols(); ++col) {
        while (2 * rest.at(col, row) >= hints.level) {
          const auto direction = best_direction(rest, {col, row}, hints.level, min_share);
          if (!direction) break;
          rest.take(line_stencil(*direction), {col, row}, hints.level);
          hints.lines.push_back({col + 0.5 - features.nadir.col, row + 0.5 - features.nadir.row,
                                 std::numbers::pi * *direction / kLineDirections});
        }
      }
    }
  }
  return hints;
}

}  // namespace roadfix
