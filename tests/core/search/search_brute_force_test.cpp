#include <gtest/gtest.h>

#include <algorithm>

#include "core/match/footprint.hpp"
#include "core/match/heading_bins.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/search/search.hpp"
#include "tests/support/padded_cells.hpp"
#include "tests/support/random_cells.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::all_poses_in;
using testing::observed_at;
using testing::padded;
using testing::pose_within;
using testing::reader_of;

/// Best score over every cell and heading bin of the map.
double brute_force(const RoadGrid& map, const FeatureMap& features, const HeadingBins& bins) {
  double best = 0.0;
  const int margin = 2 * footprint_reach(features);
  const MapPlane plane(padded(map.cells, margin));
  std::vector<PlaneCell> places;
  for (int row = 0; row < map.cells.rows(); ++row) {
    for (int col = 0; col < map.cells.cols(); ++col) places.push_back({col + margin, row + margin});
  }
  std::vector<MatchSums> sums(places.size());
  for (int bin = 0; bin < bins.count(); ++bin) {
    const PackedFootprint footprint = footprint_at(features, bins.heading(bin));
    match_sums(plane, footprint, places, sums);
    for (const MatchSums& s : sums) {
      best = std::max(best, score_of(s, footprint_cells(features)));
    }
  }
  return best;
}

TEST(Search, FindsTheBestPoseOfBruteForceOnSmallMaps) {
  // Footprints this small are scanned at the finest cells: only the approximate means of the scan could mislead it.
  std::mt19937_64 random(11);
  int missed = 0;
  constexpr int kCases = 60;
  for (int round = 0; round < kCases; ++round) {
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
    RoadGrid map{{2.0, {1000, -1000}, 30 + below(40), 30 + below(40)}, {}};
    map.cells = testing::smooth_cells(random, map.geometry.cols, map.geometry.rows);
    for (int hole = below(4); hole > 0; --hole) {
      paste(CellArray(8, 8), map.cells, below(map.geometry.cols), below(map.geometry.rows));
    }
    const PoseRegion region = all_poses_in(map.geometry.box());
    const bool unrelated = round % 3 == 0;
    const auto seen = [&] {
      const int rows = 12 + below(10);
      const int cols = 12 + below(10);
      return observed_at(map, pose_within(region.box, 14.0, random), cols, rows, 2.0, {0.2, 0.1}, random);
    };
    const FeatureMap features = unrelated ? FeatureMap::centred(testing::smooth_cells(random, 15, 13), 2.0) : seen();
    const double extent_m = 2.0 * std::max(features.cells.cols(), features.cells.rows());
    const double best = brute_force(map, features, HeadingBins::for_footprint(0.5 * extent_m, 2.0));
    const SearchResult found = search(reader_of(map), 2.0, features, region, {});
    if (best == 0.0) continue;
    if (found.modes.empty() || found.modes[0].score < best - 1e-9) ++missed;
  }
  EXPECT_EQ(missed, 0) << "of " << kCases;
}

}  // namespace
}  // namespace roadfix
