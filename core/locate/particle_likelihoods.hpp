// What a feature map says of the particles of a filter.
#pragma once

#include <optional>
#include <vector>

#include "core/filter/particles.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/measurement_model.hpp"
#include "core/locate/particle_matches.hpp"

namespace roadfix {

/// MeasurementModel::log_likelihood() of each particle, from the sums that match_particles() gave for `features`.
/// nullopt where they speak neither for nor against the belief: they show no ground, or it lies where the map shows
/// next to nothing, or neither they nor the map have roads there (a lake).
std::optional<std::vector<double>> log_likelihoods_of(const Particles& particles, const ParticleMatches& matches,
                                                      const FeatureMap& features, const MeasurementModel& model);

}  // namespace roadfix
