#include "core/track/measurement_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/match/score.hpp"

namespace roadfix {
double MeasurementModel::log_likelihood(const MatchSums& sums, std::int64_t frame_cells, double cell_m) const {
  if (kind == LikelihoodKind::kEquation7) return std::log(likelihood(rho(sums).value_or(0.0)));
  const auto cells = static_cast<double>(std::max(frame_cells, sums.n));
  if (cells == 0.0) return 0.0;
  const double independent = cells * std::min(1.0, cell_m * cell_m / kSampleM2);
  const double samples = independent / (1.0 + independent / most_samples);
  const double seen = samples * static_cast<double>(sums.n) / cells;
  const double log_ratio =
      expected_correlation * (seen * contrasted_pearson(sums) - 0.5 * samples * expected_correlation);
  return std::log(useless_share + (1.0 - useless_share) * std::exp(temper * log_ratio));
}

bool MeasurementModel::supports(double mean_likelihood) const {
  return mean_likelihood > (kind == LikelihoodKind::kEquation7 ? 0.0 : 1.0);
}

}  // namespace roadfix
