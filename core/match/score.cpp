#include "core/match/score.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

namespace {

/// Of `n` cells with this sum and sum of squares.
bool has_contrast(std::int64_t n, double sum, double squares) {
  const auto cells = static_cast<double>(n);
  return n > 0 && squares - sum * sum / cells >= kMinVariance * cells;
}

}  // namespace

bool map_has_contrast(const MatchSums& s) { return has_contrast(s.n, s.m, s.mm); }

double contrasted_pearson(const MatchSums& s) {
  return map_has_contrast(s) && has_contrast(s.n, s.l, s.ll) ? pearson(s).value_or(0.0) : 0.0;
}

FootprintCells footprint_cells(const FeatureMap& features) {
  constexpr double kMinShare = 0.5;
  const auto full = static_cast<std::int64_t>(features.cells.observed_count());
  return {full, std::max(1.0, kMinShare * static_cast<double>(full))};
}

double score_of(const MatchSums& s, const FootprintCells& cells) {
  const auto n = static_cast<double>(s.n);
  if (n < cells.min) return 0.0;
  return contrasted_pearson(s) * std::sqrt(n / static_cast<double>(cells.full));
}

}  // namespace roadfix
