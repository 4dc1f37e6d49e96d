#include "core/track/particle_likelihoods.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/grid/cell_moments.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

/// How many cells of the frame the map observes, averaged over the belief.
double mean_cells_on_map(const Particles& p, const ParticleMatches& matches) {
  double cells = 0.0;
  for (std::size_t i = 0; i < matches.sums.size(); ++i) cells += p.weight[i] * static_cast<double>(matches.sums[i].n);
  return cells;
}

}  // namespace

bool shows_roads(const FeatureMap& features) { return moments_of(features.cells).variance() >= kMinVariance; }

double share_with_roads(const Particles& p, const ParticleMatches& matches) {
  double share = 0.0;
  for (std::size_t i = 0; i < matches.sums.size(); ++i) {
    if (map_has_contrast(matches.sums[i])) share += p.weight[i];
  }
  return share;
}

std::optional<std::vector<double>> log_likelihoods_of(const Particles& particles, const ParticleMatches& matches,
                                                      const FeatureMap& features, const MeasurementModel& model) {
  constexpr double kMinShareOnMap = 0.25;
  const auto frame_cells = static_cast<double>(features.cells.observed_count());
  if (frame_cells == 0.0) return std::nullopt;
  if (model.kind != LikelihoodKind::kEquation7 &&
      mean_cells_on_map(particles, matches) < kMinShareOnMap * frame_cells) {
    return std::nullopt;
  }
  std::vector<double> log_likelihoods(matches.sums.size());
  for (std::size_t i = 0; i < log_likelihoods.size(); ++i) {
    // A frame says as much at any scale: resampled it has scale^2 times the cells, which count for as much less ground.
    const double scale = matches.scales[i];
    const std::int64_t cells = std::llround(scale * scale * frame_cells);
    log_likelihoods[i] = model.log_likelihood(matches.sums[i], cells, features.cell_m / scale);
  }
  return log_likelihoods;
}

}  // namespace roadfix
