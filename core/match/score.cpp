#include "core/match/score.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

bool has_contrast_of_map(const MatchSums& s) {
  const auto n = static_cast<double>(s.n);
  return s.n > 0 && s.mm - s.m * s.m / n >= kMinVariance * n;
}

bool has_contrast_of_features(const MatchSums& s) {
  const auto n = static_cast<double>(s.n);
  return s.n > 0 && s.ll - s.l * s.l / n >= kMinVariance * n;
}

FootprintCells footprint_cells(const FeatureMap& features) {
  constexpr double kMinShare = 0.5;
  const auto full = static_cast<std::int64_t>(features.cells.observed_count());
  return {full, std::max(1.0, kMinShare * static_cast<double>(full))};
}

double score_of(const MatchSums& s, const FootprintCells& cells) {
  const auto n = static_cast<double>(s.n);
  if (n < cells.min || !has_contrast_of_map(s) || !has_contrast_of_features(s)) return 0.0;
  return pearson(s).value_or(0.0) * std::sqrt(n / static_cast<double>(cells.full));
}

}  // namespace roadfix
