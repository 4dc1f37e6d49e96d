#include "core/locate/measurement_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/filter/filter.hpp"
#include "core/match/score.hpp"

namespace roadfix {
double MeasurementModel::log_likelihood(const MatchSums& sums, std::int64_t frame_cells, double cell_m) const {
  if (kind == LikelihoodKind::kEquation7) return std::log(likelihood(rho(sums).value_or(0.0)));
  const double samples_per_cell = std::min(1.0, cell_m * cell_m / independent_m2);
  const double samples = samples_per_cell * static_cast<double>(std::max(frame_cells, sums.n));
  const double seen = samples_per_cell * static_cast<double>(sums.n);
  const double log_ratio =
      expected_correlation * (seen * contrasted_pearson(sums) - 0.5 * samples * expected_correlation);
  constexpr double kMax = 300.0;  // large footprints may give thousands
  static_assert(kMax < kMaxLogLikelihood);
  return std::log(useless_share + (1.0 - useless_share) * std::exp(std::min(temper * log_ratio, kMax)));
}

bool MeasurementModel::supports(double mean_likelihood) const {
  return mean_likelihood > (kind == LikelihoodKind::kEquation7 ? 0.0 : 1.0);
}

}  // namespace roadfix
