#include "cli/bench/query_poses.hpp"

#include <algorithm>
#include <numbers>

namespace roadfix::bench {
namespace {

bool inside(const GridBox& box, const Footprint& footprint, const GridPose& pose) {
  return std::ranges::all_of(corners(footprint, pose), [&](GridPoint corner) { return box.contains(corner); });
}

bool all_observed(const PoseSampling& sampling, const GridPose& pose) {
  constexpr int kSide = 16;
  const auto placed = corners(sampling.footprint, pose);
  const GridPoint origin = placed[0];
  const GridPoint across{placed[1].east_m - origin.east_m, placed[1].north_m - origin.north_m};
  const GridPoint back{placed[3].east_m - origin.east_m, placed[3].north_m - origin.north_m};
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const double u = (i + 0.5) / kSide;
      const double v = (j + 0.5) / kSide;
      const GridPoint point{origin.east_m + u * across.east_m + v * back.east_m,
                            origin.north_m + u * across.north_m + v * back.north_m};
      if (!sampling.observed(point)) return false;
    }
  }
  return true;
}

}  // namespace

GridBox without(const GridBox& box, const Exclusion& exclude) {
  return {{box.min.east_m + exclude.left * box.width_m(), box.min.north_m + exclude.bottom * box.height_m()},
          {box.max.east_m - exclude.right * box.width_m(), box.max.north_m - exclude.top * box.height_m()}};
}

std::optional<GridPose> draw_pose(const PoseSampling& sampling, evaluation::Random& random) {
  constexpr int kTries = 20'000;
  const GridBox& box = sampling.region;
  if (box.empty()) return std::nullopt;
  for (int i = 0; i < kTries; ++i) {
    GridPose pose;
    pose.position.east_m = uniform(random, box.min.east_m, box.max.east_m);
    pose.position.north_m = uniform(random, box.min.north_m, box.max.north_m);
    pose.heading = Angle::radians(uniform(random, 0.0, 2.0 * std::numbers::pi));
    if (inside(box, sampling.footprint, pose) && all_observed(sampling, pose)) return pose;
  }
  return std::nullopt;
}

}  // namespace roadfix::bench
