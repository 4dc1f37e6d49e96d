// What the outside gives, made ready for the grid of a map: feature map in its cells, prior in its plane.
#pragma once

#include "core/locate/fix.hpp"
#include "core/match/search.hpp"

namespace roadfix {

/// Cells of the map or one of its overviews, the coarsest that still holds what the feature map shows.
/// Throws InvalidInput for an empty feature map, one of a size that makes no sense, and one too far from its nadir.
FeatureMap in_cells_of(const MapView& map, const FeatureMap& features);

/// Throws InvalidInput ("scale-range-out-of-range") unless it is a share from 0 to kMaxScaleRange.
void require_scale_range(double range);

/// The part of the map that the prior leaves. Throws InvalidInput where it leaves nothing.
PoseRegion region_of(const MapView& map, const Prior& prior);

}  // namespace roadfix
