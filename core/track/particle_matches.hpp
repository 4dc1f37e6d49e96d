// The sums of equation (5) at every particle of a filter.
#pragma once

#include <stop_token>
#include <vector>

#include "core/filter/particles.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"
#include "core/match/correlation.hpp"

namespace roadfix {

struct ParticleMatches {
  std::vector<MatchSums> sums;  ///< one for each particle, in their order; n = 0 for those without weight
  /// By how many times larger than told the feature map was taken to be for each particle.
  std::vector<double> scales;
};

/// `features` are in cells of the map or of an overview (see in_cells_of()), and their size may be wrong by
/// `scale_range` (see Scales). Particles share headings, and scales, in bins by which the edge of the footprint moves
/// two cells, and lie on the nearest cell. Throws Interrupted when asked to stop.
ParticleMatches match_particles(const MapView& map, const FeatureMap& features, const Particles& particles,
                                double scale_range = 0.0, int threads = 1, const std::stop_token& stop = {});

}  // namespace roadfix
