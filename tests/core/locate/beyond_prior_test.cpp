#include <gtest/gtest.h>

#include "core/locate/fix.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

class BeyondPrior : public ::testing::Test {
 protected:
  const RoadGrid map_ = testing::street_map(34, {2.0, {300'000, -3'200'000}, 1000, 800});
  const MapView view_ = testing::view_of(map_);
  std::mt19937_64 random_{34};
  const GridPose truth_ = testing::pose_within(view_.extent, 500.0, random_);

  FeatureMap seen(int cells) { return testing::observed_at(map_, truth_, cells, cells, 2.0, {0.2, 0.2}, random_); }

  Prior circle(double east_of_truth_m, double radius_m) const {
    const GridPoint centre{truth_.position.east_m + east_of_truth_m, truth_.position.north_m};
    Prior prior;
    prior.circle = GeoCircle{view_.zone.unproject(centre), radius_m};
    return prior;
  }
};

// A confidence so low that the best place inside would be a fix.
TEST_F(BeyondPrior, TheTruthIsFoundSoThatAPlaceLikeItInsideIsNoFix) {
  const FeatureMap frame = seen(200);
  FixOptions options;
  options.confidence = 0.1;
  const Fix wrong = locate(view_, frame, circle(290.0, 250.0), options);
  EXPECT_EQ(wrong.status, FixStatus::kNoFix);
  EXPECT_EQ(wrong.reason, "better-outside-prior");
  EXPECT_LT(wrong.probability, 0.1);
  const Fix right = locate(view_, frame, circle(290.0, 300.0), {});
  ASSERT_EQ(right.status, FixStatus::kFix) << right.reason;
  EXPECT_LT(distance_m(view_.zone.project(right.modes[0].pose.position), truth_.position), 2.0);
}

// Streets that repeat exactly fit as well at four headings.
TEST_F(BeyondPrior, StreetsThatRepeatGiveNoFixHoweverNarrowThePriorAndItsHeadings) {
  const RoadGrid blocks = testing::grid_city(map_.geometry, 100.0);
  const MapView view = testing::view_of(blocks);
  for (const int cells : {130, 170, 220}) {
    const FeatureMap frame = testing::observed_at(blocks, truth_, cells, cells, 2.0, {0.15, 0.15}, random_);
    for (const double half_width_deg : {5.0, 15.0, 40.0}) {
      Prior prior = circle(10.0, 30.0);
      prior.heading = HeadingRange{on_earth(truth_, view.zone).heading, Angle::degrees(half_width_deg)};
      const Fix fix = locate(view, frame, prior, {});
      EXPECT_NE(fix.status, FixStatus::kFix) << cells << " cells, " << half_width_deg << " degrees";
      EXPECT_LT(fix.probability, 0.25) << cells << " cells, " << half_width_deg << " degrees";
    }
  }
}

TEST_F(BeyondPrior, ABoxEndsAtItsSidesHoweverHighItIs) {
  const FeatureMap frame = seen(200);
  const auto fix_within = [&](double east_of_truth_m) {
    const LatLon side = view_.zone.unproject({truth_.position.east_m + east_of_truth_m, truth_.position.north_m});
    Prior prior;
    prior.box = GeoBox{{side.lat_deg - 1.0, side.lon_deg - 1.0}, {side.lat_deg + 1.0, side.lon_deg}};
    return locate(view_, frame, prior, {});
  };
  EXPECT_EQ(fix_within(-50.0).reason, "better-outside-prior");
  const Fix right = fix_within(20.0);
  ASSERT_EQ(right.status, FixStatus::kFix) << right.reason;
  EXPECT_LT(distance_m(view_.zone.project(right.modes[0].pose.position), truth_.position), 2.0);
}

// The window lies two sides ahead of the UAV, so that each degree moves it by 14 m.
TEST_F(BeyondPrior, AHeadingJustBesideTheToldOnesGivesNoFixElsewhere) {
  FeatureMap frame = seen(200);
  const double ahead_m = 800.0;
  frame.nadir.row += ahead_m / frame.cell_m;
  const GridPose uav{
      {truth_.position.east_m - ahead_m * sin(truth_.heading), truth_.position.north_m - ahead_m * cos(truth_.heading)},
      truth_.heading};
  const auto fix_beside = [&](double beside_deg) {
    Prior prior;
    const Angle half_width = Angle::degrees(5.0);
    prior.heading =
        HeadingRange{on_earth(uav, view_.zone).heading + half_width + Angle::degrees(beside_deg), half_width};
    return locate(view_, frame, prior, {});
  };
  for (const double beside_deg : {-3.0, -1.0, -0.5}) {
    const Fix right = fix_beside(beside_deg);
    ASSERT_EQ(right.status, FixStatus::kFix) << right.reason;
    EXPECT_LT(distance_m(view_.zone.project(right.modes[0].pose.position), uav.position), 4.0) << beside_deg;
  }
  for (const double beside_deg : {0.5, 1.0, 2.0, 3.0}) {
    EXPECT_EQ(fix_beside(beside_deg).reason, "better-outside-prior") << beside_deg;
  }
}

TEST_F(BeyondPrior, TheNarrowerAPriorThatHoldsTheTruthIsTheMoreProbableIsIt) {
  const FeatureMap frame = seen(70);
  std::vector<double> probabilities;
  for (const double radius_m : {700.0, 300.0, 100.0}) {
    const Fix fix = locate(view_, frame, circle(0.6 * radius_m, radius_m), {});
    ASSERT_FALSE(fix.modes.empty());
    EXPECT_LT(distance_m(view_.zone.project(fix.modes[0].pose.position), truth_.position), 4.0);
    probabilities.push_back(fix.probability);
  }
  EXPECT_GE(probabilities[1], probabilities[0] - 1e-4);
  EXPECT_GE(probabilities[2], probabilities[1] - 1e-4);
}

}  // namespace
}  // namespace roadfix
