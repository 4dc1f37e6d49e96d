#include "core/locate/match_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/grid/sampling.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/random_cells.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::pose_within;
using testing::street_map;
using testing::view_of;

// Some 100 km east of the central meridian of zone 34, at 57.7 north: convergence is more than a degree.
class MatchPoses : public ::testing::Test {
 protected:
  RoadGrid map_ = street_map(21, {2.0, {300'000, -3'200'000}, 1200, 900});
  MapView view_ = view_of(map_);
  std::mt19937_64 random_{22};
};

TEST_F(MatchPoses, ScoreExactlyAndInBins) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  const FeatureMap window = cut_out(map_, truth, 100, 100, 2.0);
  GridPose off = truth;
  off.position.east_m += 12.0;
  GridPose turned = truth;
  turned.heading += Angle::degrees(20.0);
  const std::vector<GeoPose> poses{on_earth(truth, view_.zone),
                                   on_earth(off, view_.zone),
                                   on_earth(turned, view_.zone),
                                   {{10.0, 10.0 + 11.0}, Angle()},
                                   {{40.0, -140.0}, Angle()}};
  for (const double step_deg : {0.0, 0.5}) {
    MatchOptions options;
    options.heading_step = Angle::degrees(step_deg);
    options.threads = 2;
    const std::vector<MatchScore> scores = match(view_, window, poses, options);
    ASSERT_EQ(scores.size(), 5U);
    EXPECT_GT(scores[0].rho.value(), step_deg > 0.0 ? 0.7 : 0.9);
    EXPECT_LT(scores[1].rho.value(), scores[0].rho.value());
    EXPECT_LT(scores[2].rho.value(), scores[0].rho.value());
    EXPECT_NEAR(static_cast<double>(scores[0].observed_cells), 10000.0, 150.0);
    for (const std::size_t elsewhere : {3U, 4U}) {
      EXPECT_FALSE(scores[elsewhere].rho);
      EXPECT_EQ(scores[elsewhere].observed_cells, 0);
    }
  }
}

TEST_F(MatchPoses, BesideAPoseAreThoseOfPosesThatLieSoManyCellsOff) {
  const GridPose pose = pose_within(view_.extent, 300.0, random_);
  const FeatureMap window = cut_out(map_, pose, 100, 100, 2.0);
  const std::vector<PlaneCell> offsets{{0, 0}, {15, 0}, {-3, 8}, {0, -40}};
  const std::vector<MatchSums> sums = sums_beside(view_, window, pose, offsets);
  ASSERT_EQ(sums.size(), offsets.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    GridPose beside = pose;
    beside.position.east_m += 2.0 * offsets[i].col;
    beside.position.north_m -= 2.0 * offsets[i].row;
    EXPECT_NEAR(rho(sums[i]).value(), rho_at(view_, window, beside).value(), 1e-6) << i;
    EXPECT_EQ(sums[i].n, sums_at(view_, window, beside).n) << i;
  }
}

/// Equation (5) with the feature map looked up below the middle of each cell of the map.
MatchSums by_brute_force(const RoadGrid& map, const FeatureMap& features, const GridPose& pose) {
  MatchSums sums;
  for (int row = 0; row < map.cells.rows(); ++row) {
    for (int col = 0; col < map.cells.cols(); ++col) {
      const BodyOffset at = offset_from(pose, {map.geometry.cell_center(col, row), {}});
      const Cell seen = bilinear(features.cells, {features.nadir.col + at.right_m / features.cell_m,
                                                  features.nadir.row - at.forward_m / features.cell_m});
      const Cell mapped = map.cells.at(col, row);
      if (is_observed(seen) && is_observed(mapped)) sums.add(probability(mapped), probability(seen));
    }
  }
  return sums;
}

TEST(ExactMatch, IsEquation5WhereverInACellThePoseLies) {
  constexpr double kCellM = 2.0;
  constexpr double kTolerance = 0.003;  // positions are rounded to 1/128 of a cell, cells to 1/254
  // Noise, which differs from itself half a cell farther on: roads are wider than what a wrong sign would shift them.
  std::mt19937_64 random(23);
  const RoadGrid map{{kCellM, {300'000, -3'200'000}, 100, 90}, testing::random_cells(random, 100, 90, 0.1)};
  const MapView view = view_of(map);
  for (const double heading_deg : {0.0, 33.0, 90.0, 127.5, 214.0, 301.0}) {
    for (const auto& [col, row] : {std::pair{0.07, 0.89}, {0.31, 0.22}, {0.75, 0.14}, {0.93, 0.71}}) {
      const auto pose_at = [&](double of_a_col, double of_a_row) {
        return GridPose{map.geometry.point_at({50.0 + of_a_col, 45.0 + of_a_row}), Angle::degrees(heading_deg)};
      };
      const GridPose pose = pose_at(col, row);
      const FeatureMap features = cut_out(map, pose, 45, 30, kCellM);
      const MatchSums expected = by_brute_force(map, features, pose);
      const MatchScore score = match(view, features, std::vector{on_earth(pose, view.zone)}).at(0);
      const auto where = ::testing::Message() << heading_deg << " degrees, " << col << ' ' << row << " of a cell";
      EXPECT_NEAR(score.rho.value(), rho(expected).value(), kTolerance) << where;
      EXPECT_NEAR(static_cast<double>(score.observed_cells), static_cast<double>(expected.n), 10.0)
          << where << ": at its rim the feature map covers cells by half";
      for (const GridPose& mirrored : {pose_at(1.0 - col, row), pose_at(col, 1.0 - row)}) {
        EXPECT_GT(std::abs(rho(by_brute_force(map, features, mirrored)).value() - score.rho.value()), 10.0 * kTolerance)
            << where << ": a wrong sign would not be noticed";
      }
    }
  }
}

}  // namespace
}  // namespace roadfix
