// What a feature map says of the particles of a filter.
#pragma once

#include <optional>
#include <vector>

#include "core/filter/particles.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/measurement_model.hpp"
#include "core/locate/particle_matches.hpp"

namespace roadfix {

/// Whether there is road enough in the features to compare a map with. They hold probabilities as they are: halved log
/// odds make as much of a detector's noise.
bool shows_roads(const FeatureMap& features);
/// Of the belief, the share whose ground has roads to compare a frame with, by sums of probabilities as they are.
double share_with_roads(const Particles& particles, const ParticleMatches& matches);

/// MeasurementModel::log_likelihood() of each particle, from the sums that match_particles() gave for `features`.
/// nullopt where they speak neither for nor against the belief: they show no ground, or it lies where the map shows
/// next to nothing.
std::optional<std::vector<double>> log_likelihoods_of(const Particles& particles, const ParticleMatches& matches,
                                                      const FeatureMap& features, const MeasurementModel& model);

}  // namespace roadfix
