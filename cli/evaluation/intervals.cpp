#include "cli/evaluation/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace roadfix::evaluation {
namespace {

/// P(X <= hits) for X binomial(n, p).
double binomial_cdf(int hits, int n, double p) {
  if (p <= 0.0) return 1.0;
  if (p >= 1.0) return hits >= n ? 1.0 : 0.0;
  double sum = 0.0;
  for (int k = 0; k <= hits; ++k) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(p) +
                    (n - k) * std::log1p(-p));
  }
  return sum;
}

/// The p at which the falling function P(X <= hits) crosses `target`.
double crossing(int hits, int n, double target) {
  double low = 0.0;
  double high = 1.0;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (binomial_cdf(hits, n, middle) > target ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

nlohmann::json to_json(const Interval& interval) { return {interval.low, interval.high}; }

Interval clopper_pearson(int hits, int n, double confidence) {
  if (n <= 0) return {0.0, 1.0};
  const double tail = 0.5 * (1.0 - confidence);
  return {hits == 0 ? 0.0 : crossing(hits - 1, n, 1.0 - tail), hits == n ? 1.0 : crossing(hits, n, tail)};
}

Interval chi_square_mean_band(int n, int degrees) {
  constexpr double kNormal95 = 1.959964;
  const double k = static_cast<double>(n) * degrees;
  const double spread = 2.0 / (9.0 * k);
  const auto quantile = [&](double z) {
    return degrees * std::pow(std::max(1.0 - spread + z * std::sqrt(spread), 0.0), 3);
  };
  return {quantile(-kNormal95), quantile(kNormal95)};
}

}  // namespace roadfix::evaluation
