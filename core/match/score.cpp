#include "core/match/score.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

FootprintCells footprint_cells(const FeatureMap& features) {
  constexpr double kMinShare = 0.5;
  const auto full = static_cast<std::int64_t>(features.cells.observed_count());
  return {full, std::max(1.0, kMinShare * static_cast<double>(full))};
}

double score_of(const MatchSums& s, const FootprintCells& cells) {
  const auto n = static_cast<double>(s.n);
  if (s.n == 0 || n < cells.min) return 0.0;
  const double min_squares = kMinVariance * n;
  if (s.mm - s.m * s.m / n < min_squares || s.ll - s.l * s.l / n < min_squares) return 0.0;
  return pearson(s).value_or(0.0) * std::sqrt(n / static_cast<double>(cells.full));
}

}  // namespace roadfix
