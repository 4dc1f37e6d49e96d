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

bool holds(const std::vector<CellOffset>& piece, int share, int level, double min_share) {
  return share >= min_share * level * static_cast<double>(piece.size());
}

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

BoundTerms::Term term_at(int col, int row, int plane) {
  return {static_cast<std::int16_t>(floor_div(col, kBlockCells)),
          static_cast<std::int16_t>(floor_div(row, kBlockCells)), static_cast<std::int16_t>(plane)};
}

/// Takes the lines from the remainder, each where it fits best near its place.
void add_lines(const LineHints& hints, Angle heading, int nadir_col, int nadir_row, int span, Remainder& rest,
               Weighted& terms) {
  constexpr double kMinShare = 0.3;
  const double c = cos(heading);
  const double s = sin(heading);
  for (const LineHint& hint : hints.lines) {
    const int col = static_cast<int>(std::lround(c * hint.col - s * hint.row)) + nadir_col;
    const int row = static_cast<int>(std::lround(s * hint.col + c * hint.row)) + nadir_row;
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
    if (!holds(line, best_share, hints.level, kMinShare)) continue;
    rest.take(line, best.col, best.row, hints.level);
    const double weight = static_cast<double>(line.size()) * hints.level * span / BoundMap::kFull;
    terms.emplace_back(weight, term_at(best.col - nadir_col, best.row - nadir_row, index));
  }
}

/// Sums per block of value(col, row), with the nadir's block aligned to the nadir cell.
template <typename Value>
Weighted block_terms(int cols, int rows, int nadir_col, int nadir_row, int plane, double factor, Value value) {
  const int first_col = floor_div(-nadir_col, kBlockCells);
  const int first_row = floor_div(-nadir_row, kBlockCells);
  const int block_cols = floor_div(cols - 1 - nadir_col, kBlockCells) - first_col + 1;
  const int block_rows = floor_div(rows - 1 - nadir_row, kBlockCells) - first_row + 1;
  std::vector<double> sums(static_cast<std::size_t>(block_cols) * static_cast<std::size_t>(block_rows), 0.0);
  for (int row = 0; row < rows; ++row) {
    const int block_row = floor_div(row - nadir_row, kBlockCells) - first_row;
    for (int col = 0; col < cols; ++col) {
      const int block_col = floor_div(col - nadir_col, kBlockCells) - first_col;
      sums[static_cast<std::size_t>(block_row * block_cols + block_col)] += value(col, row);
    }
  }
  Weighted terms;
  for (int row = 0; row < block_rows; ++row) {
    for (int col = 0; col < block_cols; ++col) {
      const double sum = sums[static_cast<std::size_t>(row * block_cols + col)];
      if (sum <= 0.0) continue;
      terms.emplace_back(
          sum * factor, BoundTerms::Term{static_cast<std::int16_t>(first_col + col),
                                         static_cast<std::int16_t>(first_row + row), static_cast<std::int16_t>(plane)});
    }
  }
  return terms;
}

/// Observed cells within windows of 2 kBlockCells - 1 cells, by a table of sums.
class WindowCount {
 public:
  explicit WindowCount(const CellArray& cells)
      : cols_(cells.cols()), rows_(cells.rows()), sums_(static_cast<std::size_t>((cols_ + 1) * (rows_ + 1)), 0) {
    for (int row = 0; row < rows_; ++row) {
      for (int col = 0; col < cols_; ++col) {
        sum(col + 1, row + 1) =
            sum(col, row + 1) + sum(col + 1, row) - sum(col, row) + (is_observed(cells.at(col, row)) ? 1 : 0);
      }
    }
  }
  int within(int col, int row, int size) {
    const int c0 = std::clamp(col, 0, cols_);
    const int c1 = std::clamp(col + size, 0, cols_);
    const int r0 = std::clamp(row, 0, rows_);
    const int r1 = std::clamp(row + size, 0, rows_);
    return sum(c1, r1) - sum(c0, r1) - sum(c1, r0) + sum(c0, r0);
  }

 private:
  int& sum(int col, int row) { return sums_[static_cast<std::size_t>(row * (cols_ + 1) + col)]; }

  int cols_;
  int rows_;
  std::vector<int> sums_;
};

}  // namespace

TurnedFeatures::TurnedFeatures(const FeatureMap& turned, Angle heading, int base, const LineHints& hints, int span,
                               bool whole_map) {
  const CellArray& array = turned.cells;
  const int nadir_col = static_cast<int>(std::floor(turned.nadir.col));
  const int nadir_row = static_cast<int>(std::floor(turned.nadir.row));
  for (const Cell cell : array.cells()) {
    if (!is_observed(cell)) continue;
    cells += 1.0;
    sum += cell;
    square += double{1} * cell * cell;
  }

  Remainder rest(array, base);
  Weighted pieces;
  add_lines(hints, heading, nadir_col, nadir_row, span, rest, pieces);
  const auto blocks = [&](int plane, double factor, auto value) {
    return block_terms(array.cols(), array.rows(), nadir_col, nadir_row, plane, factor / BoundMap::kFull, value);
  };
  const Weighted single = blocks(BoundMap::kCellPlane, span, [&](int c, int r) { return rest.at(c, r); });
  pieces.insert(pieces.end(), single.begin(), single.end());
  cross = quantized(std::move(pieces), Rounding::kUp);
  const auto value = [&](int c, int r) { return is_observed(array.at(c, r)) ? double{1} * array.at(c, r) : 0.0; };
  if (whole_map) {
    cover(array, nadir_col, nadir_row);
    return;
  }
  sum_min = quantized(blocks(BoundMap::kAllObserved, 1.0, value), Rounding::kDown);
  sum_max = quantized(blocks(BoundMap::kAnyObserved, 1.0, value), Rounding::kUp);
  const auto squared = [&](int c, int r) { return value(c, r) * value(c, r); };
  square_min = quantized(blocks(BoundMap::kAllObserved, 1.0, squared), Rounding::kDown);

  cover(array, nadir_col, nadir_row);
}

void TurnedFeatures::cover(const CellArray& array, int nadir_col, int nadir_row) {
  const int reach = std::max(nadir_col, nadir_row);
  const int half = (reach + kBlockCells - 1) / kBlockCells + 1;
  side = 2 * half + 1;
  inner.assign(static_cast<std::size_t>(side * side), false);
  outer = inner;
  WindowCount count(array);
  for (int row = -half; row <= half; ++row) {
    for (int col = -half; col <= half; ++col) {
      // The cells of the block as seen from the positions of the nadir's block.
      const int seen = count.within(nadir_col + kBlockCells * col - kBlockCells + 1,
                                    nadir_row + kBlockCells * row - kBlockCells + 1, kBlockWindow);
      const auto at = static_cast<std::size_t>((row + half) * side + col + half);
      inner[at] = seen == kBlockWindow * kBlockWindow;
      outer[at] = seen > 0;
    }
  }
}

std::vector<BlockRun> runs_of(const std::vector<bool>& blocks, int side) {
  std::vector<BlockRun> runs;
  const int half = side / 2;
  for (int row = 0; row < side; ++row) {
    int first = -1;
    for (int col = 0; col <= side; ++col) {
      const bool covered = col < side && blocks[static_cast<std::size_t>(row * side + col)];
      if (covered && first < 0) first = col;
      if (!covered && first >= 0) {
        runs.push_back({row - half, first - half, col - half});
        first = -1;
      }
    }
  }
  return runs;
}

}  // namespace roadfix
