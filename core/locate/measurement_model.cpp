#include "core/locate/measurement_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/filter/filter.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

/// Sum over the cells of log P(l | m) - log P(l | chance).
double detection_log_ratio(const MatchSums& s) {
  constexpr double kDetectionRate = 0.6;  // a
  constexpr double kFalseRate = 0.1;      // b
  const auto n = static_cast<double>(s.n);
  const double average = std::clamp(s.l / n, 1e-3, 1.0 - 1e-3);
  const double hit = std::log(kDetectionRate) - std::log(average);
  const double false_alarm = std::log(kFalseRate) - std::log(average);
  const double miss = std::log1p(-kDetectionRate) - std::log1p(-average);
  const double quiet = std::log1p(-kFalseRate) - std::log1p(-average);
  return s.ml * hit + (s.l - s.ml) * false_alarm + (s.m - s.ml) * miss + (n - s.m - s.l + s.ml) * quiet;
}

}  // namespace

double MeasurementModel::log_likelihood(const MatchSums& sums, std::int64_t frame_cells, double cell_m) const {
  if (kind == LikelihoodKind::kEquation7) return std::log(likelihood(rho(sums).value_or(0.0)));
  const double samples_per_cell = std::min(1.0, cell_m * cell_m / independent_m2);
  double log_ratio = 0.0;
  if (kind == LikelihoodKind::kDetectionRates) {
    if (sums.n > 0) log_ratio = samples_per_cell * detection_log_ratio(sums);
  } else {
    const double samples = samples_per_cell * static_cast<double>(std::max(frame_cells, sums.n));
    const double seen = samples_per_cell * static_cast<double>(sums.n);
    log_ratio = expected_correlation * (seen * contrasted_pearson(sums) - 0.5 * samples * expected_correlation);
  }
  constexpr double kMax = 300.0;  // large footprints may give thousands
  static_assert(kMax < kMaxLogLikelihood);
  return std::log(useless_share + (1.0 - useless_share) * std::exp(std::min(temper * log_ratio, kMax)));
}

bool MeasurementModel::supports(double mean_likelihood) const {
  return mean_likelihood > (kind == LikelihoodKind::kEquation7 ? 0.0 : 1.0);
}

}  // namespace roadfix
