// Which of the peaks that a search found are places of their own.
#pragma once

#include "core/locate/calibration.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {

/// Whether two poses are so near each other, in place and heading, that nobody would take them for two places.
bool is_same_place(const GridPose& a, const GridPose& b);

/// Another place than the best mode is one beyond the region around it that a probability speaks of (kRegionSigmas), or
/// one that is_same_place() tells from it, however wide that region. SearchResult::nearby is counted among the modes
/// and the rivals within the region if it is, and SearchResult::outside keeps those that are. `nadir_sigma_m` as of a
/// FeatureMap.
void sort_out_other_places(const MapView& map, const Calibration& calibration, double nadir_sigma_m,
                           SearchResult& found);

}  // namespace roadfix
