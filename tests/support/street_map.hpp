// Invented street maps for tests of matching, and what a detector would see of them.
#pragma once

#include <functional>
#include <random>

#include "core/grid/feature_map.hpp"
#include "core/grid/road_grid.hpp"

namespace roadfix::testing {

/// Winding main roads with side streets at odd angles, all cells observed. Two seeds have nothing in common.
RoadGrid street_map(std::uint64_t seed, const GridGeometry& geometry);

/// Streets at right angles, every `block_m` metres, 6 m wide: no place is told from the next.
RoadGrid grid_city(const GridGeometry& geometry, double block_m);

struct DetectorNoise {
  double erase = 0.0;   ///< share of the footprint in which roads are missing, in patches of about 30 m
  double invent = 0.0;  ///< roads that are not there, as a share of those that are
};

/// What a detector sees of the map at a pose: cols x rows cells.
FeatureMap observed_at(const RoadGrid& map, const GridPose& pose, int cols, int rows, double cell_m,
                       const DetectorNoise& noise, std::mt19937_64& random);

/// Reads windows of the map and its overviews, as a map file would.
std::function<RoadGrid(const GridGeometry&)> reader_of(const RoadGrid& map);

}  // namespace roadfix::testing
