// What the outside gives of a feature map, made ready for the grid of a map.
#pragma once

#include <optional>

#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {

/// What was observed of the feature map, in cells of the map or of one of its overviews: the coarsest that still hold
/// what it shows. One cell that was not observed, below the UAV, where nothing was, or only a sliver far off.
/// Throws InvalidInput for an empty feature map, one of a size that makes no sense, and one too far from its nadir.
FeatureMap in_cells_of(const MapView& map, const FeatureMap& features);

/// Throws InvalidInput ("parameter-out-of-range") unless it is a share from 0 to kMaxScaleRange.
void require_scale_range(double range);

/// Throws LimitExceeded ("search-area-too-large").
void require_searchable(double area_km2, std::optional<double> limit_km2);

}  // namespace roadfix
