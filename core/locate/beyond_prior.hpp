// Do the roads fit better just beyond the region that was searched? If the vehicle is there, a place inside that shows
// some of the same streets fits so much better than everything else inside that nothing there contradicts it.
#pragma once

#include <optional>

#include "core/locate/decision.hpp"
#include "core/match/search.hpp"

namespace roadfix {

/// What lies around `pose`, up to half the longer side of the feature map beyond the region but within the extent of
/// the map, at the headings of the region; nullopt where the region holds all of it.
std::optional<PoseRegion> ground_beyond(const PoseRegion& region, const GridBox& map_extent, const GridPose& pose,
                                        const FeatureMap& features);

/// The decision after `near`, a search of ground_beyond(), too. It is a fix no longer if another place there fits
/// better than the best mode of `found` and lies outside of the region, or if the time was over first.
Decision confirmed(Decision decision, const SearchResult& found, const PoseRegion& region, const SearchResult& near);

}  // namespace roadfix
