#include "core/match/correlation.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

// Variance below which a spread is rounding error.
constexpr double kLeastSpread = 1e-9;

}  // namespace

std::optional<double> rho(const MatchSums& s) {
  if (s.n == 0) return std::nullopt;
  const auto n = static_cast<double>(s.n);
  const double mean = (s.m + s.l) / (2.0 * n);  // (6)
  const double covariance = s.ml - n * mean * mean;
  const double map_spread = s.mm - 2.0 * mean * s.m + n * mean * mean;
  const double feature_spread = s.ll - 2.0 * mean * s.l + n * mean * mean;
  if (map_spread <= kLeastSpread * n || feature_spread <= kLeastSpread * n) return std::nullopt;
  return covariance / std::sqrt(map_spread * feature_spread);  // (5)
}

std::optional<double> pearson(const MatchSums& s) {
  if (s.n == 0) return std::nullopt;
  const auto n = static_cast<double>(s.n);
  const double map_spread = s.mm - s.m * s.m / n;
  const double feature_spread = s.ll - s.l * s.l / n;
  if (map_spread <= kLeastSpread * n || feature_spread <= kLeastSpread * n) return std::nullopt;
  return (s.ml - s.m * s.l / n) / std::sqrt(map_spread * feature_spread);
}

double likelihood(double rho) { return std::max(rho, 0.0); }

}  // namespace roadfix
