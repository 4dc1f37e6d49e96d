// Whether all of a frame shows one place. A picture of which a part is older than the rest (a decoder without the
// packets for it leaves what was there), that shows a part twice, or of which a part was moved to the other side, fits
// at the place of either: part of it, beyond chance, and the rest not at all.
#pragma once

#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {

/// "left half", "right half", "upper half" or "lower half": that half of the cells that the frame observed correlates
/// with the map at the pose less than half as well as all of them and by two standard deviations of chance, by what the
/// search compares (soft_map.hpp). "left quarter" and so on: of that quarter less than a third as well. nullptr where
/// none does. A part in which frame or map show less than a road across contradicts nothing, nor does one of which the
/// map observed less than half. `frame`: in cells of the map (in_cells_of()).
const char* contradicting_part(const MapView& map, const FeatureMap& frame, const GridPose& pose);

}  // namespace roadfix
