#include "core/locate/told_frames.hpp"

#include <cmath>

#include "core/locate/compared_cells.hpp"

namespace roadfix {
namespace {

/// Sum of squared deviations of what the search compares.
double evidence_of(const FeatureMap& features) {
  const FeatureMap compared = compared_cells(features);
  double n = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (const Cell cell : compared.cells.cells()) {
    if (!is_observed(cell)) continue;
    const double value = probability(cell);
    n += 1.0;
    sum += value;
    squares += value * value;
  }
  return n > 0.0 ? squares - sum * sum / n : 0.0;
}

/// How far from the reference what tells its place was seen from, in the mean.
double mean_distance_m(std::span<const PlacedFeatures> parts) {
  double weights = 0.0;
  double sum_m = 0.0;
  for (const PlacedFeatures& part : parts) {
    const double weight = evidence_of(part.features);
    weights += weight;
    sum_m += weight * distance_m(part.offset);
  }
  return weights > 0.0 ? sum_m / weights : 0.0;
}

}  // namespace

FeatureMap laid_together(std::span<const PlacedFeatures> parts, double max_cells) {
  FeatureMap result = combined(parts, max_cells);
  result.nadir_sigma_m = std::hypot(result.nadir_sigma_m, kToldOffsetShare * mean_distance_m(parts));
  return result;
}

}  // namespace roadfix
