// A town, what was seen somewhere in it, and where that is looked for.
#pragma once

#include <cstdint>
#include <random>

#include "core/search/search_levels.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix::testing {

struct SeenTown {
  RoadGrid map;
  GridReader read = reader_of(map);
  FeatureMap seen;
  PoseRegion region;
  std::mt19937_64 random;

  /// Of a town of cols x rows cells of 2 m; `seen` has as many cells as told, `margin_m` and more from its edge.
  SeenTown(std::uint64_t seed, int cols, int rows, double margin_m, int seen_cols, int seen_rows)
      : map(street_map(seed, {2.0, {150'000, -2'000'000}, cols, rows})), random(seed) {
    region.box = map.geometry.box();
    seen = observed_at(map, pose_within(region.box, margin_m, random), seen_cols, seen_rows, 2.0, {0.2, 0.2}, random);
  }
  SeenTown(const SeenTown&) = delete;  // `read` reads `map`
  SeenTown& operator=(const SeenTown&) = delete;

  SearchLevels levels() const { return {read, 2.0, seen, region, {}}; }
};

}  // namespace roadfix::testing
