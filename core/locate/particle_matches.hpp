// The sums of equation (5) at every particle of a filter.
#pragma once

#include <stop_token>
#include <vector>

#include "core/filter/particles.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"
#include "core/match/correlation.hpp"

namespace roadfix {

/// One for each particle, in their order. `features` are in cells of the map or of an overview (see in_cells_of()).
/// Particles share headings in bins by which the edge of the footprint moves two cells, and lie on the nearest cell.
/// Those without weight are left out: n = 0. Throws Interrupted when asked to stop.
std::vector<MatchSums> match_particles(const MapView& map, const FeatureMap& features, const Particles& particles,
                                       int threads = 1, const std::stop_token& stop = {});

}  // namespace roadfix
