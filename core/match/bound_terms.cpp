#include "core/match/bound_terms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/match/line_stencil.hpp"
#include "core/units/floor_div.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kGroups = 64;
constexpr std::size_t kMaxTermsOfGroup = 1000;  // their sum has to fit into 16 bits
constexpr double kHighestSum = 2147483648.0;

/// What is left of a feature map while pieces are taken from it.
class Remainder {
 public:
  Remainder(const CellArray& cells, int base) : cols_(cells.cols()), rows_(cells.rows()) {
    values_.reserve(cells.cells().size());
    for (const Cell cell : cells.cells()) values_.push_back(is_observed(cell) ? std::max(0, cell - base) : 0);
  }

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int at(int col, int row) const {
    return col >= 0 && row >= 0 && col < cols_ && row < rows_ ? values_[index(col, row)] : 0;
  }
  int highest() const { return values_.empty() ? 0 : *std::ranges::max_element(values_); }

  /// How much of a piece of that level is there.
  int share(const std::vector<CellOffset>& piece, int col, int row, int level) const {
    int sum = 0;
    for (const CellOffset cell : piece) sum += std::min(level, at(col + cell.col, row + cell.row));
    return sum;
  }
  void take(const std::vector<CellOffset>& piece, int col, int row, int level) {
    for (const CellOffset cell : piece) {
      const int c = col + cell.col;
      const int r = row + cell.row;
      if (c >= 0 && r >= 0 && c < cols_ && r < rows_) values_[index(c, r)] = std::max(0, values_[index(c, r)] - level);
    }
  }

 private:
  std::size_t index(int col, int row) const { return static_cast<std::size_t>(row * cols_ + col); }

  int cols_;
  int rows_;
  std::vector<int> values_;
};

}  // namespace

BoundTerms quantized(std::vector<std::pair<double, BoundTerms::Term>> weighted, Rounding rounding) {
  BoundTerms result;
  std::erase_if(weighted, [](const auto& term) { return term.first <= 0.0; });
  if (weighted.empty()) return result;
  std::ranges::sort(weighted, [](const auto& a, const auto& b) { return a.first < b.first; });
  const double max_sum = BoundMap::kFull * weighted.back().first * static_cast<double>(weighted.size());
  result.unit = std::max(1.0, max_sum / kHighestSum);
  const std::size_t size = std::clamp<std::size_t>((weighted.size() + kGroups - 1) / kGroups, 1, kMaxTermsOfGroup);
  for (std::size_t first = 0; first < weighted.size(); first += size) {
    const std::size_t end = std::min(first + size, weighted.size());
    const double weight = weighted[rounding == Rounding::kUp ? end - 1 : first].first / result.unit;
    result.groups.push_back(
        {static_cast<std::uint32_t>(rounding == Rounding::kUp ? std::ceil(weight) : std::floor(weight)),
         static_cast<std::uint32_t>(end)});
    for (std::size_t i = first; i < end; ++i) result.terms.push_back(weighted[i].second);
  }
  return result;
}

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

LineHints find_lines(const FeatureMap& features, int base) {
  Remainder rest(features.cells, base);
  LineHints hints;
  hints.level = std::max(1, rest.highest() / 3);
  for (const double min_share : {0.95, 0.85, 0.75, 0.65, 0.5, 0.4}) {
    for (int row = 0; row < rest.rows(); ++row) {
      for (int col = 0; col < rest.cols(); ++col) {
        while (2 * rest.at(col, row) >= hints.level) {
          int best = -1;
          double best_share = min_share;
          for (int i = 0; i < kLineDirections; ++i) {
            const auto& line = line_stencil(i);
            const double share = static_cast<double>(rest.share(line, col, row, hints.level)) /
                                 (hints.level * static_cast<double>(line.size()));
            if (share < best_share) continue;
            best = i;
            best_share = share;
          }
          if (best < 0) break;
          rest.take(line_stencil(best), col, row, hints.level);
          hints.lines.push_back({col + 0.5 - features.nadir.col, row + 0.5 - features.nadir.row,
                                 std::numbers::pi * best / kLineDirections});
        }
      }
    }
  }
  return hints;
}

namespace {

using Weighted = std::vector<std::pair<double, BoundTerms::Term>>;

/// Of the block (col, row), counted from the nadir's.
BoundTerms::Term term_at(int col, int row, int plane) {
  return {static_cast<std::int16_t>(col), static_cast<std::int16_t>(row), static_cast<std::int16_t>(plane)};
}

/// Takes the lines from the remainder, each where it fits best near its place.
Weighted line_terms(const LineHints& hints, Angle heading, CellOffset nadir, int span, Remainder& rest) {
  constexpr double kMinShare = 0.3;
  const double c = cos(heading);
  const double s = sin(heading);
  Weighted terms;
  for (const LineHint& hint : hints.lines) {
    const int col = static_cast<int>(std::lround(c * hint.col - s * hint.row)) + nadir.col;
    const int row = static_cast<int>(std::lround(s * hint.col + c * hint.row)) + nadir.row;
    const long turned = std::lround((hint.angle + heading.radians()) / std::numbers::pi * kLineDirections);
    const int index = static_cast<int>(((turned % kLineDirections) + kLineDirections) % kLineDirections);
    const auto& line = line_stencil(index);
    CellOffset best;
    int best_share = -1;
    for (int d = 0; d < 9; ++d) {
      const CellOffset at{col + d % 3 - 1, row + d / 3 - 1};
      const int share = rest.share(line, at.col, at.row, hints.level);
      if (share <= best_share) continue;
      best = at;
      best_share = share;
    }
    if (best_share < kMinShare * hints.level * static_cast<double>(line.size())) continue;
    rest.take(line, best.col, best.row, hints.level);
    const double weight = static_cast<double>(line.size()) * hints.level * span / BoundMap::kFull;
    terms.emplace_back(weight, term_at(floor_div(best.col - nadir.col, kBlockCells),
                                       floor_div(best.row - nadir.row, kBlockCells), index));
  }
  return terms;
}

/// Sums per block of value(col, row) over the cells, with the nadir's block aligned to the nadir cell.
template <typename Value>
Weighted block_terms(const CellArray& cells, CellOffset nadir, int plane, double factor, Value value) {
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
  Weighted terms;
  for (int row = 0; row < block_rows; ++row) {
    for (int col = 0; col < block_cols; ++col) {
      const double sum = sums[static_cast<std::size_t>(row * block_cols + col)];
      if (sum > 0.0) terms.emplace_back(sum * factor, term_at(first_col + col, first_row + row, plane));
    }
  }
  return terms;
}

}  // namespace

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

  Remainder rest(array, base);
  Weighted pieces = line_terms(hints, heading, nadir, map.span(), rest);
  const auto blocks = [&](int plane, double factor, auto value) {
    return block_terms(array, nadir, plane, factor / BoundMap::kFull, value);
  };
  const Weighted single = blocks(BoundMap::kCellPlane, map.span(), [&](int c, int r) { return rest.at(c, r); });
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
