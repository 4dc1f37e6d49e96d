// What a feature map says of the particles of a filter.
#pragma once

#include <optional>
#include <vector>

#include "core/filter/particles.hpp"
#include "core/grid/feature_map.hpp"
#include "core/track/measurement_model.hpp"
#include "core/track/particle_matches.hpp"

namespace roadfix {

/// Whether there is enough road in the features to compare with a map. Of probabilities, not of half their log odds,
/// which amplify a detector's noise.
bool shows_roads(const FeatureMap& features);
/// The share of the belief whose ground has enough road to compare a frame with. `matches`: of probabilities, too.
double share_with_roads(const Particles& particles, const ParticleMatches& matches);

/// MeasurementModel::log_likelihood() of each particle, from the sums that match_particles() gave for `features`.
/// nullopt where they neither support nor contradict the belief: they show no ground, or the map shows hardly any
/// there.
std::optional<std::vector<double>> log_likelihoods_of(const Particles& particles, const ParticleMatches& matches,
                                                      const FeatureMap& features, const MeasurementModel& model);

}  // namespace roadfix
