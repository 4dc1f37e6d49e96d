// Feature maps of stated quality, cut out of a map: what a detector of that quality would hand over.
#pragma once

#include <random>

#include "core/grid/feature_map.hpp"
#include "core/grid/road_grid.hpp"

namespace roadfix {

/// How a simulated feature map differs from the map it was cut from. All zero = not at all.
struct FeatureQuality {
  double erase = 0.0;     ///< share of the road cells that vanish, in round patches of what the map says of no road
  double invent = 0.0;    ///< road cells that appear, as a share of the true ones, as straight strokes
  double block = 0.0;     ///< share of the footprint that is not observed, in discs
  double shift_m = 0.0;   ///< 1 sigma of a common shift per axis: map and ground registered differently
  double scale = 0.0;     ///< 1 sigma of the relative error of the footprint's size (altitude, focal length)
  double tilt_deg = 0.0;  ///< 1 sigma per axis of a tilt that rectification did not know, seen from as high as the
                          ///< footprint is long; the nadir stays where it is

  friend bool operator==(const FeatureQuality&, const FeatureQuality&) = default;
};

/// The map under a footprint of cols x rows cells (of the map's size) centred on the pose, in the body frame, with the
/// quality applied. The same generator gives the same cells on every platform.
FeatureMap simulate_features(const RoadGrid& map, const GridPose& pose, int cols, int rows,
                             const FeatureQuality& quality, std::mt19937_64& random);

}  // namespace roadfix
