// Whether another peak beside the best place is a place of its own.
#pragma once

#include "core/locate/calibration.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {

/// Counts SearchResult::nearby among the modes and the rivals within the region if it is another place than the best
/// one: beyond the region of that one that a probability speaks of (kRegionSigmas), however near it is, or farther away
/// than any operator would take for the same, however wide that region. `nadir_sigma_m` as of a FeatureMap.
void count_nearby_place(const MapView& map, const Calibration& calibration, double nadir_sigma_m, SearchResult& found);

}  // namespace roadfix
