#include "core/match/score.hpp"

#include <cmath>

namespace roadfix {

double score_of(const MatchSums& s, std::int64_t full_cells, double min_cells) {
  const auto n = static_cast<double>(s.n);
  if (s.n == 0 || n < min_cells) return 0.0;
  const double min_squares = kMinVariance * n;
  if (s.mm - s.m * s.m / n < min_squares || s.ll - s.l * s.l / n < min_squares) return 0.0;
  return pearson(s).value_or(0.0) * std::sqrt(n / static_cast<double>(full_cells));
}

}  // namespace roadfix
