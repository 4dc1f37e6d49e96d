// Which of the peaks that a search found are places of their own.
#pragma once

#include "core/locate/calibration.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {

/// Whether two poses are so near each other, in place and heading, that nobody would take them for two places.
bool is_same_place(const GridPose& a, const GridPose& b);

/// Another place than the best mode is one that is_same_place() tells from it, or one beyond kRegionSigmas of it:
/// - SearchResult::nearby is counted among the modes and the rivals within the region if it lies beyond the region that
///   a probability speaks of, since sources of a map may lie beside each other by what it states of its registration.
/// - SearchResult::outside keeps those beyond the peak of the best mode alone. The registration and the nadir err for
///   both alike, and where the better one lies outside, the prior is wrong.
///
/// `nadir_sigma_m` as of a FeatureMap.
void sort_out_other_places(const MapView& map, const Calibration& calibration, double nadir_sigma_m,
                           SearchResult& found);

}  // namespace roadfix
