// Feature maps of stated quality, cut out of the map itself: what a detector of that quality would hand over.
#pragma once

#include "cli/bench/manifest.hpp"
#include "cli/bench/random.hpp"
#include "core/grid/feature_map.hpp"
#include "core/grid/road_grid.hpp"

namespace roadfix::bench {

/// The map under the footprint at the pose, with the noise applied: roads erased in round patches, roads invented as
/// straight strokes, and the whole shifted. Cells of the map's size.
FeatureMap simulate_features(const RoadGrid& map, const GridPose& pose, const Footprint& footprint,
                             const FeatureNoise& noise, Random& random);

}  // namespace roadfix::bench
