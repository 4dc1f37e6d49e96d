// Moving cells between grids of another size, place or direction. In all of these an unobserved cell contributes
// nothing, and a result cell is unobserved when less than half of what it covers was observed.
#pragma once

#include "core/grid/feature_map.hpp"
#include "core/grid/road_grid.hpp"

namespace roadfix {

/// Mean of the observed cells of each 2 x 2 block. Odd edges are padded with unobserved cells.
/// Overviews keep a cell as long as one of the four was observed, so that thin borders survive the pyramid.
CellArray halved(const CellArray& cells);

/// The same ground, `scale` times as large as the map says, in cells of another size: averaged over area when coarser,
/// bilinear when finer, and the very cells when they need not change.
FeatureMap resampled(const FeatureMap& map, double cell_m, double scale = 1.0);

/// The feature map turned to grid north-up: `heading` is the direction of its forward edge, clockwise from grid north.
/// The result is just large enough; corners that the map did not see are unobserved; nadir lies on a cell centre.
FeatureMap rotated(const FeatureMap& map, Angle heading);

/// Turned clockwise by a quarter, without rounding: rotated() by 90 degrees more, where the nadir lies on a cell
/// centre.
FeatureMap quarter_turned(const FeatureMap& map);
CellArray quarter_turned(const CellArray& cells);

/// The part of `grid` under a footprint of cols x rows cells centred on the pose, in the body frame
/// (inverse of placing a feature map at that pose). Cells beyond the grid are unobserved.
FeatureMap cut_out(const RoadGrid& grid, const GridPose& pose, int cols, int rows, double cell_m);

}  // namespace roadfix
