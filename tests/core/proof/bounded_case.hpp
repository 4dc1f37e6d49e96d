// Small random maps and feature maps, of which brute force knows the best pose.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/proof/branch_and_bound.hpp"
#include "core/units/draws.hpp"
#include "tests/support/padded_cells.hpp"
#include "tests/support/random_cells.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix::testing {

/// By seed: streets at odd angles, a regular grid of streets, smooth noise, or patches of few kinds; with or without
/// unobserved ground; a feature map that is a noisy window of the map, of its own kind, with unobserved cells, or
/// turned off its nadir.
class BoundedCase {
 public:
  explicit BoundedCase(std::uint64_t seed) : random_(seed) {
    const GridGeometry geometry{4.0, {1000 + below(9), -1000 - below(9)}, 24 + below(40), 24 + below(40)};
    const std::uint64_t kind = seed % 4;
    if (kind == 0) {
      map_ = street_map(seed, geometry);
    } else if (kind == 1) {
      map_ = grid_city(geometry, uniform(random_, 40.0, 120.0));
    } else if (kind == 2) {
      map_ = {geometry, smooth_cells(random_, geometry.cols, geometry.rows)};
    } else {
      map_ = {geometry, patches(geometry.cols, geometry.rows)};
    }
    for (int hole = seed % 3 == 0 ? below(5) : 0; hole > 0; --hole) {
      paste(CellArray(4 + below(16), 4 + below(16)), map_.cells, below(geometry.cols), below(geometry.rows));
    }
    make_features(seed);
    prepare(seed % 5 == 0);
  }
  /// Whatever the map and the feature map are.
  BoundedCase(RoadGrid map, FeatureMap features) : map_(std::move(map)), features_(std::move(features)) {
    prepare(false);
  }
  BoundedCase(const BoundedCase&) = delete;
  BoundedCase& operator=(const BoundedCase&) = delete;

  /// The first of the best poses, with a score of 0 if there is none.
  LatticePose brute_force() const {
    const int margin = 2 * footprint_reach(features_);
    const MapPlane plane(padded(map_.cells, margin));
    std::vector<PlaneCell> places;
    for (int row = 0; row < positions_.rows; ++row) {
      for (int col = 0; col < positions_.cols; ++col) {
        if (search.eligible(col, row)) places.push_back({col + margin, row + margin});
      }
    }
    std::vector<MatchSums> sums(places.size());
    LatticePose best;
    for (const int bin : search.headings) {
      const PackedFootprint footprint = footprint_at(features_, search.bins.heading(bin));
      match_sums(plane, footprint, places, sums);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const LatticeIndex cell{positions_.origin.col + places[i].col - margin,
                                positions_.origin.row + places[i].row - margin};
        const LatticePose pose{cell, bin, score_of(sums[i], search.cells)};
        if (pose.score > 0.0 && is_better(pose, best)) best = pose;
      }
    }
    return best;
  }

  BoundedSearch search;

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }

  /// `part`: not all positions are eligible.
  void prepare(bool part) {
    const GridGeometry& geometry = map_.geometry;
    positions_ = geometry;
    const int reach = footprint_reach(features_) + BoundMap::kBorder;
    const CellArray wide = padded(map_.cells, reach);
    const LatticeIndex origin{geometry.origin.col - reach, geometry.origin.row - reach};
    bound_map_ = std::make_unique<BoundMap>(RoadGrid{{4.0, origin, wide.cols(), wide.rows()}, wide});
    search.map = bound_map_.get();
    search.features = &features_;
    search.bins = HeadingBins::for_footprint(2.0 * std::max(features_.cells.cols(), features_.cells.rows()), 4.0);
    for (int bin = 0; bin < search.bins.count(); ++bin) search.headings.push_back(bin);
    search.positions = positions_;
    search.eligible = [part](int col, int row) { return !part || (col + 2 * row) % 7 < 4; };
    search.cells = footprint_cells(features_);
  }

  /// Of doubtful, likely and certain road: neighbouring places with as much of it differ in how sure it is.
  CellArray patches(int cols, int rows) {
    CellArray cells(cols, rows, kNoRoad);
    for (int left = 2 + below(60); left > 0; --left) {
      const std::array<int, 3> kinds{20 + below(60), 100 + below(60), kRoad};
      const auto kind = static_cast<Cell>(kinds.at(static_cast<std::size_t>(below(3))));
      paste(CellArray(1 + below(6), 1 + below(6), kind), cells, below(cols), below(rows));
    }
    return cells;
  }

  void make_features(std::uint64_t seed) {
    const int least = seed % 4 == 3 ? 4 : 8;
    const int cols = least + below(12);
    const int rows = least + below(12);
    if (seed % 6 == 5) {
      features_ = FeatureMap::centred(smooth_cells(random_, cols, rows), 4.0);
    } else {
      const GridPose pose{map_.geometry.cell_center(below(map_.geometry.cols), below(map_.geometry.rows)),
                          Angle::degrees(uniform(random_, 0, 360))};
      const double errors = seed % 4 == 3 ? 0.0 : 0.2;  // what fits all but perfectly leaves bounds the least room
      features_ = observed_at(map_, pose, cols, rows, 4.0, {errors, errors}, random_);
    }
    if (seed % 7 == 1) paste(CellArray(5, 4), features_.cells, below(cols), below(rows));
    if (seed % 8 == 2) features_.nadir.row += 4.0;
    if (seed % 9 == 3) {
      for (Cell& cell : features_.cells.cells()) cell = is_observed(cell) ? static_cast<Cell>(20 + cell / 3) : cell;
    }
  }

  std::mt19937_64 random_;
  RoadGrid map_;
  FeatureMap features_;
  GridGeometry positions_;
  std::unique_ptr<BoundMap> bound_map_;
};

inline void expect_same(const LatticePose& found, const LatticePose& expected) {
  EXPECT_EQ(found.score, expected.score);
  EXPECT_EQ(found.cell, expected.cell);
  EXPECT_EQ(found.bin, expected.bin);
}

/// A pose just better than what is known must survive all bounds; the best one must end the search.
inline void expect_brute_force_agrees(const BoundedCase& given) {
  if (given.search.features->cells.observed_count() == 0) return;
  const LatticePose best = given.brute_force();
  BoundedSearch search = given.search;
  search.known = std::nextafter(best.score, 0.0);
  const BoundedResult found = search_with_bound(search, Deadline());
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.bound, best.score);
  ASSERT_EQ(found.better.has_value(), best.score > 0.0);
  if (found.better) expect_same(*found.better, best);
}

}  // namespace roadfix::testing
