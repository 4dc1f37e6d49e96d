// Checks of what is searched for and where, and the feature map in cells of the map.
#pragma once

#include <optional>

#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {

/// The observed part of the feature map, in cells of the map or of the coarsest overview that still holds its detail. A
/// single unobserved cell below the UAV if nothing was observed, or only a sliver far away. Throws InvalidInput for a
/// feature map that is empty, too large, of an impossible cell size, or too far from its nadir.
FeatureMap in_cells_of(const MapView& map, const FeatureMap& features);

/// Throws InvalidInput ("parameter-out-of-range") unless it is a share from 0 to kMaxScaleRange.
void require_scale_range(double range);

/// Throws LimitExceeded ("search-area-too-large").
void require_searchable(double area_km2, std::optional<double> limit_km2);

}  // namespace roadfix
