// Poses of tests: regions of them, and some drawn at random.
#pragma once

#include <random>

#include "core/units/draws.hpp"
#include "core/units/planar.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix::testing {

/// At every heading.
inline PoseRegion all_poses_in(const GridBox& box) {
  PoseRegion region;
  region.box = box;
  return region;
}

/// Uniform over the box, less a margin on every side, and over all headings.
inline GridPose pose_within(const GridBox& box, double margin_m, std::mt19937_64& random) {
  return {{uniform(random, box.min.east_m + margin_m, box.max.east_m - margin_m),
           uniform(random, box.min.north_m + margin_m, box.max.north_m - margin_m)},
          Angle::degrees(uniform(random, 0, 360))};
}

}  // namespace roadfix::testing
