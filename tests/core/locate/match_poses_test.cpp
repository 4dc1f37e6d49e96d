#include "core/locate/match_poses.hpp"

#include <gtest/gtest.h>

#include "core/grid/resample.hpp"
#include "tests/support/map_view.hpp"
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

}  // namespace
}  // namespace roadfix
