#include "core/locate/fix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/grid/resample.hpp"
#include "tests/core/locate/locate_fixture.hpp"
#include "tests/support/random_pose.hpp"

namespace roadfix {
namespace {

using testing::Locate;
using testing::observed_at;
using testing::pose_within;

TEST_F(Locate, FixesAWindowOfTheMapInTrueHeading) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  ASSERT_GT(std::abs(view_.zone.convergence(truth.position).degrees()), 0.5);
  const Fix fix = locate(view_, observed_at(map_, truth, 200, 200, 2.0, {0.2, 0.2}, random_), {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason << ' ' << fix.probability;
  EXPECT_GE(fix.probability, 0.99);
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 2.0);
  EXPECT_LT(angular_distance(fix.modes[0].pose.heading, on_earth(truth, view_.zone).heading).degrees(), 0.5);
  EXPECT_EQ(fix.map.name, view_.id.name);
  EXPECT_NEAR(fix.searched_km2, 2.4 * 1.8, 1e-6);
  EXPECT_GE(fix.modes[0].ellipse.sigma_m[0], fix.modes[0].ellipse.sigma_m[1]);
}

TEST_F(Locate, SaysTheSameWhateverCellsTheSearchesBeforeItHad) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  Prior prior;
  prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 200.0};
  FixOptions options;
  options.search.proof_time = std::chrono::minutes(5);
  const FeatureMap features = observed_at(map_, truth, 200, 200, 2.0, {0.2, 0.2}, random_);
  const Fix alone = locate(view_, features, prior, options);
  view_.searches = std::make_shared<SearchCache>(std::size_t{1} << 30);
  locate(view_, resampled(features, 4.0), prior, options);
  const Fix after = locate(view_, features, prior, options);
  EXPECT_EQ(after.figures->lead, alone.figures->lead);
  EXPECT_EQ(after.probability, alone.probability);
  EXPECT_EQ(after.proof->bound, alone.proof->bound);
  EXPECT_EQ(after.proof->excluded_share, alone.proof->excluded_share);
}

TEST_F(Locate, TellsWhatWasProvenWhereAProofIsAskedFor) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  Prior prior;
  prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 100.0};
  FixOptions options;
  const FeatureMap features = observed_at(map_, truth, 150, 150, 2.0, {0.1, 0.1}, random_);
  EXPECT_FALSE(locate(view_, features, prior, options).proof.has_value());
  options.search.proof_time = std::chrono::minutes(5);
  const Fix fix = locate(view_, features, prior, options);
  ASSERT_TRUE(fix.proof.has_value());
  EXPECT_TRUE(fix.proof->complete);
  EXPECT_LT(error_m(fix.modes.at(0).pose, truth), 2.0);
}

TEST_F(Locate, CountsHowWellTheNadirIsKnownInItsAccuracy) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  FeatureMap features = observed_at(map_, truth, 200, 200, 2.0, {0.1, 0.1}, random_);
  const Fix exact = locate(view_, features, {}, {});
  features.nadir_sigma_m = 7.0;
  const Fix fix = locate(view_, features, {}, {});
  ASSERT_FALSE(fix.modes.empty());
  for (const std::size_t axis : {0U, 1U}) {
    EXPECT_NEAR(fix.modes[0].ellipse.sigma_m[axis], std::hypot(exact.modes.at(0).ellipse.sigma_m[axis], 7.0), 1e-9);
  }
  EXPECT_EQ(fix.probability, exact.probability);
}

TEST_F(Locate, CountsHowWellTheNadirIsKnownInTheSizeThatTheGroundHas) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  FeatureMap features = observed_at(map_, truth, 200, 200, 2.0, {0.1, 0.1}, random_);
  features.cell_m = 1.8;
  FixOptions options;
  options.search.scale_range = 0.15;
  const Fix exact = locate(view_, features, {}, options);
  features.nadir_sigma_m = 7.0;
  const Fix fix = locate(view_, features, {}, options);
  ASSERT_FALSE(fix.modes.empty());
  ASSERT_NEAR(fix.modes[0].scale, 2.0 / 1.8, 0.02);
  EXPECT_NEAR(fix.modes[0].ellipse.sigma_m[0],
              std::hypot(exact.modes.at(0).ellipse.sigma_m[0], fix.modes[0].scale * 7.0), 1e-9);
}

TEST_F(Locate, CountsHowFarTheGroundMayBeTurnedInItsHeading) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  FeatureMap features = observed_at(map_, truth, 250, 250, 1.6, {0.1, 0.1}, random_);  // in other cells than the map's
  const Fix exact = locate(view_, features, {}, {});
  features.nadir_heading_sigma = Angle::degrees(1.0);
  const Fix fix = locate(view_, features, {}, {});
  ASSERT_FALSE(fix.modes.empty());
  EXPECT_NEAR(fix.modes[0].heading_sigma.degrees(), std::hypot(exact.modes.at(0).heading_sigma.degrees(), 1.0), 1e-9);
  EXPECT_EQ(fix.probability, exact.probability);
}

TEST_F(Locate, TakesFinerCellsThanTheMapHas) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  const Fix fix = locate(view_, cut_out(map_, truth, 600, 600, 0.6), {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason;
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 1.0);
}

TEST_F(Locate, ReportsTheNadirWhereverItLiesInTheFeatureMap) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  FeatureMap window = cut_out(map_, truth, 200, 200, 2.0);
  // The camera looks ahead: the UAV is 100 m behind the centre of what it sees.
  window.nadir.row += 50.0;
  const GridPose behind{
      {truth.position.east_m - 100.0 * sin(truth.heading), truth.position.north_m - 100.0 * cos(truth.heading)},
      truth.heading};
  const Fix fix = locate(view_, window, {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason;
  EXPECT_LT(error_m(fix.modes[0].pose, behind), 1.0);
}

TEST_F(Locate, WithANarrowPriorIsSureOfSmallerFootprints) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  const GeoPose geo_truth = on_earth(truth, view_.zone);
  Prior prior;
  prior.circle = GeoCircle{geo_truth.position, 60.0};
  prior.heading = HeadingRange{geo_truth.heading, Angle::degrees(15.0)};
  const Fix fix = locate(view_, observed_at(map_, truth, 150, 150, 2.0, {0.1, 0.1}, random_), prior, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason << ' ' << fix.probability;
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 2.0);
}

TEST_F(Locate, WhatIsAFixIsOneForAKnownHeadingToo) {
  for (int round = 0; round < 2; ++round) {
    const GridPose truth = pose_within(view_.extent, 300.0, random_);
    const FeatureMap seen = observed_at(map_, truth, 180, 180, 2.0, {0.4, 0.4}, random_);
    const Fix unknown = locate(view_, seen, {}, {});
    ASSERT_EQ(unknown.status, FixStatus::kFix) << unknown.reason << ' ' << unknown.probability;
    for (const double half_width : {10.0, 60.0}) {
      Prior prior;
      prior.heading = {on_earth(truth, view_.zone).heading + Angle::degrees(0.3 * half_width),
                       Angle::degrees(half_width)};
      const Fix known = locate(view_, seen, prior, {});
      EXPECT_EQ(known.status, FixStatus::kFix) << half_width << ' ' << known.reason << ' ' << known.probability;
    }
  }
}

TEST_F(Locate, TheEllipseHoldsTheErrors) {
  // Normalised estimation error squared over many fixes, position and heading: 3 on average if the covariance is right.
  // The band is wide on purpose: what is excluded is a covariance that is wrong by its kind.
  double nees = 0.0;
  int fixes = 0;
  for (int round = 0; round < 8; ++round) {
    const GridPose truth = pose_within(view_.extent, 300.0, random_);
    Prior prior;
    prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 100.0};
    const Fix fix = locate(view_, observed_at(map_, truth, 150, 150, 2.0, {0.2, 0.2}, random_), prior, {});
    if (fix.status != FixStatus::kFix) continue;
    ++fixes;
    const FixMode& mode = fix.modes[0];
    const GridPoint at = view_.zone.project(mode.pose.position);
    const double east = at.east_m - truth.position.east_m;
    const double north = at.north_m - truth.position.north_m;
    const Angle major = view_.zone.grid_from_true(mode.ellipse.heading, at);
    const double along = east * sin(major) + north * cos(major);
    const double across = east * cos(major) - north * sin(major);
    const double turn =
        (mode.pose.heading - on_earth(truth, view_.zone).heading).wrapped().radians() / mode.heading_sigma.radians();
    nees += std::pow(along / mode.ellipse.sigma_m[0], 2) + std::pow(across / mode.ellipse.sigma_m[1], 2) + turn * turn;
  }
  ASSERT_GT(fixes, 4);
  EXPECT_LT(nees / fixes, 6.0);
  EXPECT_GT(nees / fixes, 0.02);
}

}  // namespace
}  // namespace roadfix
