#include "core/proof/turned_features.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "core/proof/bound_map.hpp"
#include "core/units/floor_div.hpp"

namespace roadfix {
namespace {

/// For the block (col, row) relative to the nadir's.
BoundTerms::Term term_at(int col, int row, int plane) {
  return {static_cast<std::int16_t>(col), static_cast<std::int16_t>(row), static_cast<std::int16_t>(plane)};
}

/// Index of the line stencil whose direction is nearest.
int nearest_direction(double radians) {
  const auto turned = static_cast<int>(std::lround(radians / std::numbers::pi * kLineDirections));
  return ((turned % kLineDirections) + kLineDirections) % kLineDirections;
}

struct Placed {
  CellOffset at;
  int share = -1;
};

/// Where among a cell and its neighbours the remainder holds most of the piece.
Placed best_near(const RoadRemainder& rest, const std::vector<CellOffset>& piece, CellOffset place, int level) {
  Placed best;
  for (int row = -1; row <= 1; ++row) {
    for (int col = -1; col <= 1; ++col) {
      const CellOffset at{place.col + col, place.row + row};
      const int share = rest.share(piece, at, level);
      if (share > best.share) best = {at, share};
    }
  }
  return best;
}

/// Takes the lines from the remainder, each where it fits best near its place.
WeightedTerms line_terms(const LineHints& hints, Angle heading, CellOffset nadir, int span, RoadRemainder& rest) {
  constexpr double kMinShare = 0.3;
  const double c = cos(heading);
  const double s = sin(heading);
  WeightedTerms terms;
  for (const LineHint& hint : hints.lines) {
    const CellOffset place{static_cast<int>(std::lround(c * hint.col - s * hint.row)) + nadir.col,
                           static_cast<int>(std::lround(s * hint.col + c * hint.row)) + nadir.row};
    const int direction = nearest_direction(hint.angle + heading.radians());
    const auto& line = line_stencil(direction);
    const auto [at, share] = best_near(rest, line, place, hints.level);
    if (share < kMinShare * hints.level * static_cast<double>(line.size())) continue;
    rest.take(line, at, hints.level);
    const double weight = static_cast<double>(line.size()) * hints.level * span / BoundMap::kFull;
    terms.emplace_back(weight, term_at(floor_div(at.col - nadir.col, kBlockCells),
                                       floor_div(at.row - nadir.row, kBlockCells), direction));
  }
  return terms;
}

/// Sums per block of value(col, row) over the cells, with the nadir's block aligned to the nadir cell.
template <typename Value>
WeightedTerms block_terms(const CellArray& cells, CellOffset nadir, int plane, double factor, Value value) {
  const int first_col = floor_div(-nadir.col, kBlockCells);
  const int first_row = floor_div(-nadir.row, kBlockCells);
  const int block_cols = floor_div(cells.cols() - 1 - nadir.col, kBlockCells) - first_col + 1;
  const int block_rows = floor_div(cells.rows() - 1 - nadir.row, kBlockCells) - first_row + 1;
  std::vector<double> sums(static_cast<std::size_t>(block_cols) * static_cast<std::size_t>(block_rows), 0.0);
  for (int row = 0; row < cells.rows(); ++row) {
    const int block_row = floor_div(row - nadir.row, kBlockCells) - first_row;
    for (int col = 0; col < cells.cols(); ++col) {
      const int block_col = floor_div(col - nadir.col, kBlockCells) - first_col;
      sums[static_cast<std::size_t>(block_row * block_cols + block_col)] += value(col, row);
    }
  }
  WeightedTerms terms;
  for (int row = 0; row < block_rows; ++row) {
    for (int col = 0; col < block_cols; ++col) {
      const double sum = sums[static_cast<std::size_t>(row * block_cols + col)];
      if (sum > 0.0) terms.emplace_back(sum * factor, term_at(first_col + col, first_row + row, plane));
    }
  }
  return terms;
}

}  // namespace

int base_of(const FeatureMap& features) {
  std::vector<Cell> observed;
  std::ranges::copy_if(features.cells.cells(), std::back_inserter(observed), is_observed);
  if (observed.empty()) return 0;
  const auto middle = observed.begin() + static_cast<std::ptrdiff_t>(observed.size() / 2);
  std::ranges::nth_element(observed, middle);
  return *middle;
}

FeatureMap above_base(const FeatureMap& features, int base) {
  FeatureMap above = features;
  for (Cell& cell : above.cells.cells()) {
    cell = is_observed(cell) && cell > base ? static_cast<Cell>(cell - base) : kUnobserved;
  }
  return above;
}

TurnedFeatures::TurnedFeatures(const FeatureMap& turned, Angle heading, int base, const LineHints& hints,
                               const BoundMap& map) {
  const CellArray& array = turned.cells;
  const CellOffset nadir{static_cast<int>(std::floor(turned.nadir.col)),
                         static_cast<int>(std::floor(turned.nadir.row))};
  for (const Cell cell : array.cells()) {
    if (!is_observed(cell)) continue;
    cells += 1.0;
    sum += cell;
    square += double{1} * cell * cell;
  }
  cover = cover_of(array, nadir);
  runs = runs_of(array.cols(), array.rows(), nadir, [&](int c, int r) { return is_observed(array.at(c, r)); });

  RoadRemainder rest(array, base);
  WeightedTerms pieces = line_terms(hints, heading, nadir, map.span(), rest);
  const auto blocks = [&](int plane, double factor, auto value) {
    return block_terms(array, nadir, plane, factor / BoundMap::kFull, value);
  };
  const WeightedTerms single = blocks(BoundMap::kCellPlane, map.span(), [&](int c, int r) { return rest.at(c, r); });
  pieces.insert(pieces.end(), single.begin(), single.end());
  cross = quantized(std::move(pieces), Rounding::kUp);
  if (map.all_observed()) return;

  const auto value = [&](int c, int r) { return is_observed(array.at(c, r)) ? double{1} * array.at(c, r) : 0.0; };
  sum_min = quantized(blocks(BoundMap::kAllObserved, 1.0, value), Rounding::kDown);
  sum_max = quantized(blocks(BoundMap::kAnyObserved, 1.0, value), Rounding::kUp);
  const auto squared = [&](int c, int r) { return value(c, r) * value(c, r); };
  square_min = quantized(blocks(BoundMap::kAllObserved, 1.0, squared), Rounding::kDown);
}

}  // namespace roadfix
