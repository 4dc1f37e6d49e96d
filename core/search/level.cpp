#include "core/search/level.hpp"

#include <cmath>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/match/footprint.hpp"

namespace roadfix {

GridPose Level::pose_of(const LatticePose& pose) const { return grid_pose_of(pose, cell_m(), bins); }

LevelFeatures::LevelFeatures(FeatureMap features)
    : map(std::move(features)), rotator(map), cells(footprint_cells(map)) {}

LevelFeatures Level::at_scale(int index) const {
  if (index == 0) return features;
  return LevelFeatures(resampled(source, cell_m(), scales.factor(index)));
}

int Level::reach(int scale) const {
  const int reach = footprint_reach(features.map);
  return scale == 0 ? reach : static_cast<int>(std::ceil(scales.factor(scale) * reach)) + 1;
}

}  // namespace roadfix
